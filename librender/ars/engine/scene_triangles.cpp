#include "librender/ars/engine/scene_triangles.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tbb/parallel_for.h>

#include "librender/ars/engine/vertex_color.h"
#include "librender/ars/words/pixel_packet.h"
#include "librender/objects/border_stitcher.h"
#include "librender/objects/model_object_processor.h"
#include "librender/objects/part_meshes.h"
#include "librender/reference/reference_texture.h"
#include "librender/scene/model_tree_processor.h"
#include "librender/scene/pose_table.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/seam_index.h"
#include "librender/scene/stopwatch.h"

namespace deltaz::ars {

namespace {

struct NodeTriangles {
  std::vector<ViewTriangle> triangles;
  std::vector<std::uint64_t> identity;
  std::uint64_t in = 0, back_facing = 0;
};

ViewVertex viewVertex(const Vector3& position, const std::array<double, kColors>& color) {
  return {position.x, position.y, position.z, color};
}

// The lit colours of a node's vertices: the colour map's where it covers them, by rule elsewhere.
Result<std::vector<LinearColor>> litColors(const Environment& environment, std::uint16_t grid,
                                           const TerrainVertices& vertices, ReferenceTexture& texture) {
  std::vector<LinearColor> colors;
  colors.reserve(vertices.position.size());
  for (std::size_t n = 0; n < vertices.position.size(); ++n) {
    const TerrainVertex vertex = vertices.at(n);
    if (environment.color_map == nullptr) {
      colors.push_back(vertex.color);
      continue;
    }
    DELTAZ_TRY_ASSIGN(const LinearColor color,
                      texture.shade(vertex.color, vertex.intensity, grid, {vertex.texture, vertices.step}));
    colors.push_back(color);
  }
  return colors;
}

// The nodes of the schedule, read, placed and lit.
struct Terrain {
  std::vector<TerrainTile> tiles;
  std::vector<TerrainVertices> vertices;
  std::vector<ProcessedNode> processed;  // one for each node of the cut
};

Result<Terrain> readTerrain(const Database& database, const Environment& environment,
                            const Schedule& schedule, const std::vector<std::uint8_t>& wanted,
                            FrameStatistics& statistics) {
  const std::size_t count = schedule.nodes.size();
  std::vector<std::optional<Result<TerrainTile>>> read(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
    if (wanted[n] != 0) read[n].emplace(database.terrain(schedule.nodes[n].node));
  });
  Terrain terrain;
  terrain.tiles.resize(count);
  terrain.vertices.resize(count);
  terrain.processed.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    if (!read[n]) continue;
    if (!read[n]->ok()) return read[n]->error();
    terrain.tiles[n] = std::move(*read[n]).value();
    const TerrainTile& tile = terrain.tiles[n];
    statistics.posts_decoded +=
        static_cast<std::uint64_t>(tile.columns) * static_cast<std::uint64_t>(tile.rows);
  }
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
    if (!read[n]) return;
    const TerrainTile& tile = terrain.tiles[n];
    terrain.vertices[n] =
        terrainVertices(tile, database.grid(tile.grid), environment.view, environment.light);
    terrain.processed[n] = {&terrain.tiles[n], &terrain.vertices[n]};
  });
  return terrain;
}

Result<NodeTriangles> terrainTriangles(const Environment& environment, const BorderStitcher& stitcher,
                                       const SeamIndex& seams, const CutNode& node, std::uint32_t of_cut,
                                       const TerrainTile& tile) {
  TerrainSplits splits;
  TerrainVertices vertices = stitcher.vertices(of_cut, splits);
  TerrainFaces faces = terrainFaces(tile, vertices.position, splits, seams.replacedFaces(tile));
  for (const TerrainFace& face : stitcher.seamFaces(of_cut, vertices))
    addFace(faces, vertices.position, face);
  ReferenceTexture texture(environment.color_map);
  DELTAZ_TRY_ASSIGN(const std::vector<LinearColor> lit,
                    litColors(environment, node.node.record.grid, vertices, texture));
  std::vector<std::optional<ViewVertex>> seen(vertices.position.size());
  NodeTriangles made;
  made.in = faces.in;
  made.back_facing = faces.back_facing;
  for (const TerrainFace& face : faces.front) {
    ViewTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = face.vertex[k];
      if (!seen[v])
        seen[v] = viewVertex(vertices.position[v],
                             vertexColor(environment, Surface::kTerrain, vertices.position[v], lit[v]));
      triangle.vertex[k] = *seen[v];
    }
    made.triangles.push_back(triangle);
    made.identity.push_back(std::uint64_t{node.node.number} << 32 | face.identity);
  }
  return made;
}

NodeTriangles modelTriangles(const Environment& environment, const ModelMesh& mesh, const DrawnPart& part) {
  const ModelFaces faces = modelFaces(mesh, part.to_earth, environment.view, environment.light);
  NodeTriangles made;
  made.in = faces.in;
  made.back_facing = faces.back_facing;
  for (const ModelFace& face : faces.front) {
    ViewTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3& position = faces.position[face.vertex[k]];
      triangle.vertex[k] =
          viewVertex(position, vertexColor(environment, Surface::kModel, position, face.color[k]));
    }
    made.triangles.push_back(triangle);
    made.identity.push_back(std::uint64_t{part.instance} << 32 | face.identity);
  }
  return made;
}

void append(NodeTriangles&& made, SceneTriangles& scene, FrameStatistics::Triangles& counts) {
  scene.triangles.insert(scene.triangles.end(), made.triangles.begin(), made.triangles.end());
  scene.identity.insert(scene.identity.end(), made.identity.begin(), made.identity.end());
  counts.in += made.in;
  counts.back_facing += made.back_facing;
}

}  // namespace

Result<SceneTriangles> sceneTriangles(const Database& database, const Environment& environment,
                                      const RenderOptions& options, FrameStatistics& statistics) {
  Stopwatch watch;
  const SeamIndex seams(database);
  ScheduleOptions levels{options.tolerance, options.fixed_level};
  levels.cull = options.cull;
  DELTAZ_TRY_ASSIGN(const Schedule schedule,
                    scheduleNodes(database, seams, environment.view, levels, statistics.nodes));
  statistics.level = schedule.level;
  statistics.coarsest_level = schedule.coarsest_level;
  statistics.full_resolution = schedule.full_resolution;
  DELTAZ_TRY_ASSIGN(const PoseTable poses, PoseTable::of(database, options.poses));
  DELTAZ_TRY_ASSIGN(
      const ModelSchedule models,
      processModelTrees(modelSceneOf(database), poses, environment.view,
                        {options.tolerance, options.fixed_level, options.cull}, statistics.models));
  statistics.projected_error = std::max(schedule.projected_error, models.projected_error);
  statistics.milliseconds.schedule += watch.lap();

  const CutIndex index(database, schedule.nodes);
  DELTAZ_TRY_ASSIGN(
      const Terrain terrain,
      readTerrain(database, environment, schedule, nodesToProcess(schedule.nodes, index, seams), statistics));
  DELTAZ_TRY_ASSIGN(const PartMeshes meshes, PartMeshes::read(database, models.parts));
  statistics.milliseconds.read += watch.lap();

  const BorderStitcher stitcher(database, schedule.nodes, index, seams, terrain.processed,
                                environment.color_map != nullptr);
  std::vector<std::optional<Result<NodeTriangles>>> made(schedule.front_to_back.size());
  tbb::parallel_for(std::size_t{0}, made.size(), [&](std::size_t n) {
    const std::uint32_t of_cut = schedule.front_to_back[n];
    made[n].emplace(terrainTriangles(environment, stitcher, seams, schedule.nodes[of_cut], of_cut,
                                     terrain.tiles[of_cut]));
  });
  SceneTriangles scene;
  for (std::optional<Result<NodeTriangles>>& node : made) {
    if (!node->ok()) return node->error();
    append(std::move(*node).value(), scene, statistics.triangles);
  }
  scene.terrain = scene.triangles.size();
  std::vector<NodeTriangles> of_models(models.parts.size());
  tbb::parallel_for(std::size_t{0}, of_models.size(), [&](std::size_t p) {
    of_models[p] = modelTriangles(environment, meshes.of(p), models.parts[p]);
  });
  for (NodeTriangles& part : of_models) append(std::move(part), scene, statistics.triangles);
  statistics.milliseconds.objects += watch.lap();
  return scene;
}

namespace {

// What sea and sky look like at places of a picture.
class Background {
 public:
  using Color = std::array<double, kColors>;

  Background(const Environment& environment, int first_i, int first_j)
      : environment_(environment),
        first_i_(first_i),
        first_j_(first_j),
        known_(kScreenLines * kScreenPixels) {}

  const Color& at(int i, int j) {
    std::optional<Color>& color =
        known_[static_cast<std::size_t>(i) * kScreenPixels + static_cast<std::size_t>(j)];
    if (!color) color = seen(i, j);
    return *color;
  }

 private:
  Color seen(int i, int j) const {
    const Vector3 ray = environment_.view.ray(first_j_ + j, first_i_ + i);
    const double u = environment_.sea.depth(ray);
    if (!(u < std::numeric_limits<double>::infinity()))
      return displayedColor(environment_.atmosphere.sky(ray));
    return displayedColor(seenColor(environment_, ray, Surface::kSea, u, environment_.sea.color(ray, u)));
  }

  const Environment& environment_;
  int first_i_, first_j_;
  std::vector<std::optional<Color>> known_;
};

// A square of pixels, and the two triangles that have all of them, each one once: background is written in
// whatever order the tilers come, so no two triangles of it may have a pixel in common.
//
//   a a a a      corners of a: first pixel, last of the first line, last of the first column
//   a a a b      corners of b: last of the second line, last pixel, last of the second column
//   a a b b
//   a b b b
struct Square {
  int i, j, side;
};

class BackgroundMaker {
 public:
  BackgroundMaker(Background& background, std::vector<BackgroundTriangle>& out)
      : background_(background), out_(out) {}

  void add(const Square& square) {
    if (square.side > kSmallestBackground && !isLinear(square)) {
      const int half = square.side / 2;
      for (const int di : {0, half}) {
        for (const int dj : {0, half}) add({square.i + di, square.j + dj, half});
      }
      return;
    }
    const int last_i = square.i + square.side - 1, last_j = square.j + square.side - 1;
    addTriangle({{{square.i, square.j}, {square.i, last_j}, {last_i, square.j}}});
    addTriangle({{{square.i + 1, last_j}, {last_i, last_j}, {last_i, square.j + 1}}});
  }

 private:
  using Place = std::array<int, 2>;

  void addTriangle(const std::array<Place, 3>& corner) {
    BackgroundTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corner[k] = {static_cast<double>(corner[k][0]), static_cast<double>(corner[k][1])};
      triangle.color[k] = background_.at(corner[k][0], corner[k][1]);
    }
    out_.push_back(triangle);
  }

  // Whether the two triangles of the square show what they stand for, looked at in a lattice of places.
  bool isLinear(const Square& square) {
    constexpr int kSteps = 8;
    const int last = square.side - 1;
    const auto corner = [&](int di, int dj) { return background_.at(square.i + di, square.j + dj); };
    const Background::Color nw = corner(0, 0), ne = corner(0, last), sw = corner(last, 0),
                            se = corner(last, last);
    for (int down = 0; down <= kSteps; ++down) {
      for (int across = 0; across <= kSteps; ++across) {
        const int di = last * down / kSteps, dj = last * across / kSteps;
        const double x = static_cast<double>(dj) / last, y = static_cast<double>(di) / last;
        const Background::Color is = corner(di, dj);
        for (std::size_t c = 0; c < kColors; ++c) {
          const double shown = di + dj <= last
                                   ? nw[c] + (ne[c] - nw[c]) * x + (sw[c] - nw[c]) * y
                                   : se[c] + (sw[c] - se[c]) * (1 - x) + (ne[c] - se[c]) * (1 - y);
          if (std::abs(shown - is[c]) > kBackgroundStep) return false;
        }
      }
    }
    return true;
  }

  Background& background_;
  std::vector<BackgroundTriangle>& out_;
};

}  // namespace

std::vector<BackgroundTriangle> backgroundTriangles(const Environment& environment, int first_i, int first_j,
                                                    int lines, int pixels) {
  Background background(environment, first_i, first_j);
  std::vector<BackgroundTriangle> triangles;
  BackgroundMaker maker(background, triangles);
  for (int i = 0; i < lines; i += kLargestBackground) {
    for (int j = 0; j < pixels; j += kLargestBackground) maker.add({i, j, kLargestBackground});
  }
  return triangles;
}

}  // namespace deltaz::ars
