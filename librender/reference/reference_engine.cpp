#include "librender/reference/reference_engine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>
#include <unordered_map>
#include <vector>

#include "libdb/access/grid_locator.h"
#include "libdb/access/seam_geometry.h"
#include "librender/antialias/sample_grid.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/reference/reference_models.h"
#include "librender/reference/reference_texture.h"
#include "librender/scene/arena.h"
#include "librender/scene/environment.h"
#include "librender/scene/seam_index.h"
#include "librender/scene/stopwatch.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

struct Vertex {
  Vector3 position;  // view space
  LinearColor color;
  double intensity = 0;
  GridCoordinates texture;
};

struct Triangle {
  std::array<const Vertex*, 3> vertex{};
  std::uint16_t grid = 0;
  std::uint64_t identity = 0;
  Surface surface = Surface::kTerrain;
};

// What is nearest in a sample so far.
struct Sample {
  double inverse_u = 0, centre_inverse_u = 0;  // there, and of its plane at the pixel's centre
  LinearColor color;
  double intensity = 0;
  std::uint16_t grid = 0;
  ReferenceFootprint texture;
  std::uint64_t identity = 0;
  Surface surface = Surface::kTerrain;
};

// Inclusive pixel ranges that hold all a triangle can cover; only there to save time.
struct Box {
  int first_j, last_j, first_i, last_i;
};

// GeographicLib's own formula where the grid is geodetic; the control points' where it is not.
Vector3 positionOf(const GridGeometry& geometry, const TerrainTile& tile, int i, int j, double height) {
  const std::int64_t step = std::int64_t{1} << tile.level;
  const std::int64_t column = (tile.first_column + i) * step, row = (tile.first_row + j) * step;
  if (!geometry.isGeodetic()) return geometry.placeAt(column, row).at(height);
  return toEarthCentred(geometry.header().ellipsoid,
                        {geometry.latitude(row), geometry.longitude(column), height});
}

std::vector<Vertex> verticesOf(const TerrainTile& tile, const GridGeometry& geometry,
                               const Environment& environment) {
  const TerrainShading shading = terrainShading(tile, geometry, environment.light);
  const std::int64_t step = std::int64_t{1} << tile.level;
  std::vector<Vertex> vertices;
  vertices.reserve(shading.color.size());
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const double height = geometry.metres(tile.height(i, j));
      const std::size_t post = vertices.size();
      vertices.push_back({environment.view.toView(positionOf(geometry, tile, i, j, height)),
                          shading.color[post],
                          shading.intensity[post],
                          {static_cast<double>((tile.first_column + i) * step),
                           static_cast<double>((tile.first_row + j) * step)}});
    }
  }
  return vertices;
}

// Appends the triangle unless it is turned away from the eye.
void addTriangle(std::vector<Triangle>& triangles, FrameStatistics::Triangles& counts, const Vertex& a,
                 const Vertex& b, const Vertex& c, std::uint16_t grid, std::uint64_t identity) {
  ++counts.in;
  const Vector3 normal = cross(b.position - a.position, c.position - a.position);
  if (dot(normal, a.position) >= 0) {
    ++counts.back_facing;
    return;
  }
  triangles.push_back({{&a, &b, &c}, grid, identity, Surface::kTerrain});
}

// The valid faces of a tile that are not turned away from the eye and that no seam has replaced.
std::vector<Triangle> trianglesOf(const TerrainTile& tile, const std::vector<Vertex>& vertices,
                                  std::uint32_t record, const std::vector<std::uint8_t>& replaced,
                                  FrameStatistics::Triangles& counts) {
  const auto grid = static_cast<std::uint16_t>(tile.grid);
  std::vector<Triangle> triangles;
  for (int j = 0; j + 1 < tile.rows; ++j) {
    for (int i = 0; i + 1 < tile.columns; ++i) {
      const auto post = [&](int di, int dj) -> const Vertex& {
        return vertices[static_cast<std::size_t>(j + dj) * static_cast<std::size_t>(tile.columns) +
                        static_cast<std::size_t>(i + di)];
      };
      const std::size_t bottom =
          2 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns - 1) +
               static_cast<std::size_t>(i));
      const auto identity = std::uint64_t{record} << 32 | bottom;
      if (tile.bottomFaceValid(i, j) && (replaced.empty() || replaced[bottom] == 0))
        addTriangle(triangles, counts, post(0, 0), post(1, 0), post(1, 1), grid, identity);
      if (tile.topFaceValid(i, j) && (replaced.empty() || replaced[bottom + 1] == 0))
        addTriangle(triangles, counts, post(0, 0), post(1, 1), post(0, 1), grid, identity | 1);
    }
  }
  return triangles;
}

// The posts of all leaves, by grid and place.
class AllPosts {
 public:
  AllPosts(const Database& database, const std::vector<Node>& nodes,
           const std::vector<std::vector<Vertex>>& vertices)
      : database_(database), vertices_(vertices) {
    for (std::size_t n = 0; n < nodes.size(); ++n) leaves_.emplace(positionOf(nodes[n].record), n);
  }
  // The leaf that has cell (column, row), or the last one before the grid's end.
  std::size_t leaf(std::uint16_t grid, std::int64_t column, std::int64_t row) const {
    const GridGeometry& geometry = database_.grid(grid);
    const std::int64_t cells = geometry.header().leaf_cells;
    return leaves_.at(
        {grid, 0,
         static_cast<std::int32_t>(floorDivide(std::min(column, geometry.columnsAt(0).end - 2), cells)),
         static_cast<std::int32_t>(floorDivide(std::min(row, geometry.rowsAt(0).end - 2), cells))});
  }
  const Vertex& post(std::uint16_t grid, std::int64_t column, std::int64_t row) const {
    const std::size_t n = leaf(grid, column, row);
    const GridGeometry& geometry = database_.grid(grid);
    const std::int64_t cells = geometry.header().leaf_cells;
    const auto within = [&](std::int64_t index, PostRange posts) {
      const std::int64_t node = floorDivide(std::min(index, posts.end - 2), cells);
      return geometry.nodePosts(posts, static_cast<std::int32_t>(node));
    };
    const PostRange columns = within(column, geometry.columnsAt(0)), rows = within(row, geometry.rowsAt(0));
    return vertices_[n][static_cast<std::size_t>((row - rows.begin) * columns.size() +
                                                 (column - columns.begin))];
  }

 private:
  const Database& database_;
  const std::vector<std::vector<Vertex>>& vertices_;
  std::unordered_map<NodePosition, std::size_t, NodePositionHash> leaves_;
};

// With texture coordinates in grid `drawing`.
std::vector<Vertex> seamVertices(const Seam& seam, const AllPosts& posts, const Database& database,
                                 std::uint16_t drawing) {
  const GridLocator locator(database.grid(drawing));
  std::vector<Vertex> vertices;
  for (const SeamVertex& vertex : seam.vertices) {
    const std::uint16_t grid = vertex.side == SeamSide::kUpper ? seam.upper : seam.lower;
    const auto post = [&](std::int64_t column, std::int64_t row) {
      Vertex result = posts.post(grid, column, row);
      if (grid == drawing) return result;
      const auto place = locator.locatePost(database.grid(grid), column, row);
      constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
      result.texture = {place ? static_cast<double>(place->column) + place->x : kUnknown,
                        place ? static_cast<double>(place->row) + place->y : kUnknown};
      return result;
    };
    const Vertex p0 = post(vertex.column, vertex.row);
    Vertex sum = p0;
    const auto lean = [&](const std::array<std::int8_t, 2>& step, double weight) {
      if (weight == 0) return;
      const Vertex p = post(vertex.column + step[0], vertex.row + step[1]);
      sum.position = sum.position + (p.position - p0.position) * weight;
      sum.color = sum.color + (p.color + p0.color * -1) * weight;
      sum.intensity += (p.intensity - p0.intensity) * weight;
      sum.texture.column += (p.texture.column - p0.texture.column) * weight;
      sum.texture.row += (p.texture.row - p0.texture.row) * weight;
    };
    lean(vertex.to_p1, vertex.weight1);
    lean(vertex.to_p2, vertex.weight2);
    vertices.push_back(sum);
  }
  return vertices;
}

// What a seam draws in the place of one grid's own faces, added to the triangles of its leaves.
void addSeamTriangles(const Seam& seam, SeamSide side, const std::vector<Vertex>& vertices,
                      const AllPosts& posts, const Database& database, const std::vector<Node>& nodes,
                      std::vector<std::vector<Triangle>>& triangles,
                      std::vector<FrameStatistics::Triangles>& counts) {
  const std::uint16_t grid = gridOf(seam, side);
  const GridGeometry& geometry = database.grid(grid);
  for (const ReplacedFace& replaced : seam.replacedOf(side)) {
    const std::size_t n = posts.leaf(grid, replaced.column, replaced.row);
    const PostRange columns = geometry.nodePosts(geometry.columnsAt(0), nodes[n].record.x);
    const PostRange rows = geometry.nodePosts(geometry.rowsAt(0), nodes[n].record.y);
    const auto cell = static_cast<std::uint64_t>((replaced.row - rows.begin) * (columns.size() - 1) +
                                                 (replaced.column - columns.begin));
    const std::uint64_t identity = std::uint64_t{nodes[n].number} << 32 | cell << 1 | (replaced.top ? 1 : 0);
    for (std::uint32_t f = 0; f < replaced.face_count; ++f) {
      const auto& face = seam.faces[replaced.first_face + f];
      addTriangle(triangles[n], counts[n], vertices[face[0]], vertices[face[1]], vertices[face[2]], grid,
                  identity);
    }
  }
}

Box boxOf(const Triangle& triangle, const ViewTransform& view) {
  const Box everything{0, view.width - 1, 0, view.height - 1};
  const Box nothing{0, -1, 0, -1};
  double left = 1e300, right = -1e300, top = 1e300, bottom = -1e300;
  int behind = 0, outside_left = 0, outside_right = 0, outside_top = 0, outside_bottom = 0;
  for (const Vertex* vertex : triangle.vertex) {
    const Vector3& p = vertex->position;
    behind += p.x <= kHither;
    outside_left += p.y < -view.width * p.x;
    outside_right += p.y > view.width * p.x;
    outside_top += p.z < -view.height * p.x;
    outside_bottom += p.z > view.height * p.x;
    left = std::min(left, p.y / p.x);
    right = std::max(right, p.y / p.x);
    top = std::min(top, p.z / p.x);
    bottom = std::max(bottom, p.z / p.x);
  }
  if (behind == 3 || outside_left == 3 || outside_right == 3 || outside_top == 3 || outside_bottom == 3)
    return nothing;
  if (behind > 0) return everything;
  const auto pixel = [](double value, int limit) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(limit)));
  };
  return {std::max(0, pixel(view.centre_j + left - 1, view.width)),
          std::min(view.width - 1, pixel(view.centre_j + right + 1, view.width)),
          std::max(0, pixel(view.centre_i + top - 1, view.height)),
          std::min(view.height - 1, pixel(view.centre_i + bottom + 1, view.height))};
}

// 1/U of the vertices at most and at least, of what lies in front of the hither plane.
std::array<double, 2> inverseDepths(const Triangle& triangle) {
  std::array<double, 2> range = {1 / kHither, 0};
  for (const Vertex* vertex : triangle.vertex) {
    const double inverse_u = 1 / std::max(vertex->position.x, kHither);
    range = {std::min(range[0], inverse_u), std::max(range[1], inverse_u)};
  }
  return range;
}

// Draws what of the triangle lies in rows first_i .. last_i of the sample grid. Returns whether it covered a
// sample there.
bool draw(const Triangle& triangle, const Box& box, const ViewTransform& view, const SampleGrid& grid,
          int first_i, int last_i, std::vector<Sample>& samples, FrameStatistics::Samples& counts) {
  const Vector3 &a = triangle.vertex[0]->position, &b = triangle.vertex[1]->position,
                &c = triangle.vertex[2]->position;
  const Vector3 edge_a = cross(b, c), edge_b = cross(c, a), edge_c = cross(a, b);
  // The face's plane: normal . p = constant; on the ray, 1/U = normal . ray / constant.
  const Vector3 normal = cross(b - a, c - a);
  const double constant = dot(normal, a);
  const std::array<double, 2> range = inverseDepths(triangle);
  const auto ray_at = [&](double j, double i) { return Vector3{1, j - view.centre_j, i - view.centre_i}; };
  bool covers = false;
  for (int i = std::max(first_i, box.first_i); i <= std::min(last_i, box.last_i); ++i) {
    for (int j = box.first_j; j <= box.last_j; ++j) {
      const Vector3 ray = ray_at(grid.placeJ(j, i), grid.placeI(j, i));
      // For a front face all three are negative inside; each is its vertex's weight times a common factor.
      const double weight_a = dot(edge_a, ray), weight_b = dot(edge_b, ray), weight_c = dot(edge_c, ray);
      if (weight_a > 0 || weight_b > 0 || weight_c > 0) continue;
      const double sum = weight_a + weight_b + weight_c;
      const double inverse_u = dot(normal, ray) / constant;
      if (!(sum < 0) || !(inverse_u > 0) || inverse_u >= 1 / kHither) continue;
      covers = true;
      ++counts.tested;
      Sample& sample = samples[static_cast<std::size_t>(i) * static_cast<std::size_t>(view.width) +
                               static_cast<std::size_t>(j)];
      if (inverse_u <= sample.inverse_u) continue;
      ++counts.written;
      const auto& [first, second, third] = triangle.vertex;
      sample.inverse_u = inverse_u;
      const Vector3 centre = ray_at(grid.centre(j / grid.across()), grid.centre(i / grid.across()));
      sample.centre_inverse_u = std::clamp(dot(normal, centre) / constant, range[0], range[1]);
      sample.color = first->color * (weight_a / sum) + second->color * (weight_b / sum) +
                     third->color * (weight_c / sum);
      sample.intensity = first->intensity * (weight_a / sum) + second->intensity * (weight_b / sum) +
                         third->intensity * (weight_c / sum);
      sample.grid = triangle.grid;
      sample.texture = referenceFootprint({a, b, c}, {first->texture, second->texture, third->texture}, ray);
      sample.texture.pixel_size *= grid.across();
      sample.surface = triangle.surface;
      sample.identity = triangle.identity;
    }
  }
  return covers;
}

// What a sample shows: nothing of the terrain, then the sea or the sky.
struct SeenSample {
  LinearColor color;  // through the haze
  Surface surface = Surface::kSky;
  double u = 0;
};

Result<SeenSample> seenAt(const Sample& sample, const Environment& environment, const Vector3& ray,
                          ReferenceTexture& texture) {
  const double sea_u = environment.sea.depth(ray);
  const double nearest_u = 1 / sample.inverse_u;  // infinite where there is none
  SeenSample seen;
  if (sample.inverse_u > 0 && nearest_u <= sea_u) {
    seen = {sample.color, sample.surface, nearest_u};
    if (sample.surface == Surface::kTerrain) {
      DELTAZ_TRY_ASSIGN(seen.color,
                        texture.shade(sample.color, sample.intensity, sample.grid, sample.texture));
    }
  } else if (sea_u < std::numeric_limits<double>::infinity()) {
    seen = {environment.sea.color(ray, sea_u), Surface::kSea, sea_u};
  } else {
    seen = {environment.atmosphere.sky(ray), Surface::kSky, sea_u};
  }
  seen.color = seenColor(environment, ray, seen.surface, seen.u, seen.color);
  return seen;
}

// Every sample is shaded, whatever its neighbours show. `environment` is that of the sample grid.
Result<Picture> finish(const std::vector<Sample>& samples, const Environment& environment,
                       const RenderOptions& options, FrameStatistics& statistics) {
  Picture picture = makePicture(options);
  ReferenceTexture texture(environment.color_map);
  const SampleGrid grid(options.sampling);
  const int columns = environment.view.width, rows = environment.view.height;
  const auto at = [&](int j, int i) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(j);
  };
  std::vector<SeenSample> seen(samples.size());
  std::uint64_t covered = 0;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const Vector3 ray = environment.view.ray(grid.placeJ(j, i), grid.placeI(j, i));
      DELTAZ_TRY_ASSIGN(seen[at(j, i)], seenAt(samples[at(j, i)], environment, ray, texture));
      covered += samples[at(j, i)].inverse_u > 0;
      statistics.samples.shaded += seen[at(j, i)].surface >= Surface::kTerrain;
    }
  }

  const FilterKernel kernel(options.sampling);
  const int across = grid.across(), reach = kernel.reach();
  const int central = centralSample(samplePlaces(options.sampling.count, options.sampling.pattern));
  for (int i = 0; i < picture.height; ++i) {
    for (int j = 0; j < picture.width; ++j) {
      LinearColor sum;
      for (int ni = std::max(0, i - reach); ni <= std::min(picture.height - 1, i + reach); ++ni) {
        for (int nj = std::max(0, j - reach); nj <= std::min(picture.width - 1, j + reach); ++nj) {
          for (int s = 0; s < options.sampling.count; ++s) {
            sum = sum + seen[at(nj * across + s % across, ni * across + s / across)].color *
                            kernel.weight(nj - j, ni - i, s);
          }
        }
      }
      const std::size_t nearest = at(j * across + central % across, i * across + central / across);
      const std::size_t pixel =
          static_cast<std::size_t>(i) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(j);
      double u = seen[nearest].u;
      if (seen[nearest].surface >= Surface::kTerrain) {
        u = 1 / samples[nearest].centre_inverse_u;
        if (options.keep_triangle_ids) picture.triangle[pixel] = samples[nearest].identity;
      } else if (seen[nearest].surface == Surface::kSea) {
        const double at_centre = environment.sea.depth(environment.view.ray(grid.centre(j), grid.centre(i)));
        if (at_centre < std::numeric_limits<double>::infinity()) u = at_centre;
      }
      storeSeen(seen[nearest].surface, u, sum * (1 / kernel.sum(j, i, picture.width, picture.height)), pixel,
                picture);
    }
  }
  statistics.color_tiles = texture.tilesRead();
  if (covered > 0)
    statistics.depth_complexity =
        static_cast<double>(statistics.samples.tested) / static_cast<double>(covered);
  return picture;
}

// Of all placed models, with the vertices they refer to.
std::vector<Triangle> modelTriangles(const std::vector<ReferenceModelTriangle>& models,
                                     std::vector<Vertex>& vertices) {
  vertices.resize(3 * models.size());
  std::vector<Triangle> triangles(models.size());
  for (std::size_t t = 0; t < models.size(); ++t) {
    triangles[t].identity = models[t].identity;
    triangles[t].surface = Surface::kModel;
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[3 * t + k].position = models[t].position[k];
      vertices[3 * t + k].color = models[t].color[k];
      triangles[t].vertex[k] = &vertices[3 * t + k];
    }
  }
  return triangles;
}

Result<Picture> renderInArena(const Database& database, const RenderOptions& options,
                              FrameStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t bytes_before = database.bytesRead();
  DELTAZ_TRY(checkSampling(options));
  DELTAZ_TRY_ASSIGN(const Environment environment, makeEnvironment(database, onSampleGrid(options)));
  const SampleGrid sample_grid(options.sampling);
  const ViewTransform& view = environment.view;

  std::vector<Node> nodes;
  for (int grid = 0; grid < database.gridCount(); ++grid) {
    DELTAZ_TRY_ASSIGN(const std::vector<Node> of_grid, nodesOfLevel(database, grid, 0));
    nodes.insert(nodes.end(), of_grid.begin(), of_grid.end());
  }
  statistics.nodes.visited = statistics.nodes.drawn = nodes.size();
  DELTAZ_TRY_ASSIGN(const PoseTable poses, PoseTable::of(database, options.poses));
  statistics.milliseconds.schedule = watch.lap();

  std::vector<std::optional<Result<TerrainTile>>> tiles(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(),
                    [&](std::size_t n) { tiles[n].emplace(database.terrain(nodes[n])); });
  for (const std::optional<Result<TerrainTile>>& tile : tiles) {
    if (!tile->ok()) return tile->error();
    statistics.posts_decoded +=
        static_cast<std::uint64_t>(tile->value().columns) * static_cast<std::uint64_t>(tile->value().rows);
  }
  DELTAZ_TRY_ASSIGN(const std::vector<ReferenceModelTriangle> models,
                    referenceModels(database, poses, environment, statistics));
  statistics.milliseconds.read = watch.lap();

  const SeamIndex seams(database);
  std::vector<std::vector<Vertex>> vertices(nodes.size());
  std::vector<std::vector<Triangle>> triangles(nodes.size());
  std::vector<FrameStatistics::Triangles> of_node(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t n) {
    const TerrainTile& tile = tiles[n]->value();
    vertices[n] = verticesOf(tile, database.grid(tile.grid), environment);
    triangles[n] = trianglesOf(tile, vertices[n], nodes[n].number, seams.replacedFaces(tile), of_node[n]);
  });
  const AllPosts posts(database, nodes, vertices);
  std::vector<std::vector<Vertex>> of_seams;
  for (const Seam& seam : database.seams()) {
    for (const SeamSide side : {SeamSide::kUpper, SeamSide::kLower}) {
      of_seams.push_back(seamVertices(seam, posts, database, gridOf(seam, side)));
      addSeamTriangles(seam, side, of_seams.back(), posts, database, nodes, triangles, of_node);
    }
  }
  std::vector<Vertex> of_models;
  triangles.push_back(modelTriangles(models, of_models));
  of_node.emplace_back();  // models have counted theirs
  statistics.milliseconds.objects = watch.lap();

  // Bands of rows do not touch each other's samples; each sees all triangles in the same order.
  constexpr int kBands = 8;
  std::vector<Sample> samples(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  std::vector<std::vector<std::uint8_t>> covers(triangles.size());
  for (std::size_t n = 0; n < triangles.size(); ++n) covers[n].assign(triangles[n].size(), 0);
  std::vector<FrameStatistics::Samples> of_band(kBands);
  tbb::parallel_for(0, kBands, [&](int band) {
    const int first_i = view.height * band / kBands, last_i = view.height * (band + 1) / kBands - 1;
    for (std::size_t n = 0; n < triangles.size(); ++n) {
      for (std::size_t t = 0; t < triangles[n].size(); ++t) {
        const Box box = boxOf(triangles[n][t], view);
        if (box.last_i < first_i || box.first_i > last_i) continue;
        if (draw(triangles[n][t], box, view, sample_grid, first_i, last_i, samples,
                 of_band[static_cast<std::size_t>(band)]))
          std::atomic_ref<std::uint8_t>(covers[n][t]).store(1, std::memory_order_relaxed);
      }
    }
  });
  for (const FrameStatistics::Samples& counts : of_band) {
    statistics.samples.tested += counts.tested;
    statistics.samples.written += counts.written;
  }
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    statistics.triangles.in += of_node[n].in;
    statistics.triangles.back_facing += of_node[n].back_facing;
    for (std::size_t t = 0; t < triangles[n].size(); ++t) {
      const Box box = boxOf(triangles[n][t], view);
      const bool outside = box.first_i > box.last_i || box.first_j > box.last_j;
      ++(covers[n][t] != 0 ? statistics.triangles.drawn
         : outside         ? statistics.triangles.clipped
                           : statistics.triangles.no_sample);
    }
  }
  statistics.milliseconds.raster = watch.lap();

  DELTAZ_TRY_ASSIGN(Picture picture, finish(samples, environment, options, statistics));
  statistics.bytes_read = database.bytesRead() - bytes_before;
  statistics.milliseconds.resolve = watch.lap();
  statistics.milliseconds.total = watch.total();
  return picture;
}

}  // namespace

Result<Picture> ReferenceEngine::render(const Database& database, const RenderOptions& options,
                                        FrameStatistics& statistics) const {
  statistics = {};
  return drawOnThreads(options.threads, [&] { return renderInArena(database, options, statistics); });
}

}  // namespace deltaz
