#include "tests/librender/cut_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <stdexcept>

#include "libdb/access/grid_locator.h"
#include "libdb/access/plan_shape.h"
#include "librender/scene/view_volume.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

using Post = std::array<std::int64_t, 2>;

// An edge of a face by the numbers of its posts, the smaller first.
struct Edge {
  std::uint64_t low = 0, high = 0;
  bool forward = false;  // from low to high
  auto operator<=>(const Edge&) const = default;
};

// Numbers posts so that equal posts get equal numbers.
std::uint64_t numberOf(std::uint16_t grid, const Post& post) {
  constexpr std::int64_t kMiddle = std::int64_t{1} << 23;
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 24) - 1;
  return std::uint64_t{grid} << 48 | (static_cast<std::uint64_t>(post[0] + kMiddle) & kMask) << 24 |
         (static_cast<std::uint64_t>(post[1] + kMiddle) & kMask);
}
// The post of a number, given any post of the same area.
Post postOf(std::uint64_t number, const Post& near) {
  const auto decode = [](std::uint64_t bits, std::int64_t beside) {
    constexpr std::int64_t kMiddle = std::int64_t{1} << 23, kTurn = std::int64_t{1} << 24;
    std::int64_t value = static_cast<std::int64_t>(bits & (kTurn - 1)) - kMiddle;
    value += (beside - value + (beside >= value ? kTurn / 2 : -kTurn / 2)) / kTurn * kTurn;
    return value;
  };
  return {decode(number >> 24, near[0]), decode(number, near[1])};
}

bool sameBits(const Vector3& a, const Vector3& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

std::string nameOf(const Post& post) {
  return fmt::format("({}, {})", post[0], post[1]);
}

// Whether the cut draws a face over the place, given in level-0 posts, of a grid.
bool drawnAt(const CutMesh& mesh, const CutIndex& index, std::uint16_t grid, double x, double y) {
  const std::uint32_t n =
      index.holding(grid, static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y)));
  if (n == CutIndex::kNone || !mesh.tiles[n]) return false;
  const TerrainTile& tile = *mesh.tiles[n];
  const double step = std::ldexp(1.0, tile.level);
  const double u = x / step - static_cast<double>(tile.first_column),
               v = y / step - static_cast<double>(tile.first_row);
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  if (i < 0 || j < 0 || i + 1 >= tile.columns || j + 1 >= tile.rows) return false;
  return u - i > v - j ? tile.bottomFaceValid(i, j) : tile.topFaceValid(i, j);
}

// Where the line post + t * up meets the plane of a face, and how far inside the face that is: the smallest
// barycentric coordinate.
struct Meeting {
  Vector3 place;
  double inside = 0;
};
Meeting meet(const MeshNode& node, const std::array<std::uint32_t, 3>& face, const Vector3& post,
             const Vector3& up) {
  const Vector3 &a = node.vertices.position[face[0]], &b = node.vertices.position[face[1]],
                &c = node.vertices.position[face[2]];
  const Vector3 normal = cross(b - a, c - a);
  const Vector3 place = post + up * (dot(normal, a - post) / dot(normal, up));
  const auto share = [&](const Vector3& from, const Vector3& to) {
    return dot(cross(to - from, place - from), normal) / dot(normal, normal);
  };
  return {place, std::min({share(a, b), share(b, c), share(c, a)})};
}

// The node's face that a vertical line meets, or comes nearest to: where faces stand on a pole, the one that
// indices name may be a wall, and the ground is another's.
std::array<std::uint32_t, 3> faceOver(const MeshNode& node, const Vector3& post, const Vector3& up) {
  std::array<std::uint32_t, 3> best = {};
  double inside = -std::numeric_limits<double>::infinity();
  for (const auto& face : node.faces) {
    // A wall seen edge on is met nowhere in particular.
    constexpr double kWall = 1e-9;
    const Vector3 &a = node.vertices.position[face[0]], &b = node.vertices.position[face[1]],
                  &c = node.vertices.position[face[2]];
    const Vector3 normal = cross(b - a, c - a);
    if (std::abs(dot(normal, up)) <= kWall * length(normal) * length(up)) continue;
    const Meeting meeting = meet(node, face, post, up);
    if (!(meeting.inside > inside)) continue;
    inside = meeting.inside;
    best = face;
  }
  return best;
}

}  // namespace

CutMesh meshOfCut(const Database& database, const Schedule& schedule, const ViewTransform& view,
                  MeshPart part) {
  CutMesh mesh;
  mesh.cut = schedule.nodes;
  const CutIndex index(database, mesh.cut);
  const SeamIndex seams(database);
  const std::vector<std::uint8_t> wanted = part == MeshPart::kWholeCut
                                               ? std::vector<std::uint8_t>(mesh.cut.size(), 1)
                                               : nodesToProcess(mesh.cut, index, seams);
  std::vector<TerrainVertices> vertices(mesh.cut.size());
  mesh.tiles.resize(mesh.cut.size());
  std::vector<ProcessedNode> processed(mesh.cut.size());
  for (std::size_t n = 0; n < mesh.cut.size(); ++n) {
    if (wanted[n] == 0) continue;
    Result<TerrainTile> tile = database.terrain(mesh.cut[n].node);
    if (!tile.ok()) throw std::runtime_error(tile.error().message());
    mesh.tiles[n] = std::move(tile).value();
    const GridGeometry& geometry = database.grid(mesh.tiles[n]->grid);
    // Colours do not matter here, and normals cost most.
    TerrainVertices& of_node = vertices[n];
    of_node.columns = mesh.tiles[n]->columns;
    of_node.rows = mesh.tiles[n]->rows;
    of_node.position = terrainPositions(*mesh.tiles[n], geometry, view);
    of_node.light.resize(of_node.position.size());
    processed[n] = {&*mesh.tiles[n], &vertices[n]};
  }
  const BorderStitcher stitcher(database, mesh.cut, index, seams, processed);
  for (std::uint32_t n = 0; n < mesh.cut.size(); ++n) {
    if (part == MeshPart::kInView ? !mesh.cut[n].in_view : wanted[n] == 0) continue;
    MeshNode node;
    node.cut_node = n;
    TerrainSplits splits;
    node.vertices = stitcher.vertices(n, splits, &node.posts);
    // A tile seen from far above its middle has only front faces; positions in plan do for that.
    std::vector<Vector3> plan;
    for (const Post& post : node.posts)
      plan.push_back({-1, static_cast<double>(post[0] - node.posts[0][0]),
                      static_cast<double>(post[1] - node.posts[0][1])});
    for (Vector3& p : plan) p.x = 1;
    const std::vector<std::uint8_t> replaced = seams.replacedFaces(*mesh.tiles[n]);
    const TerrainFaces faces = terrainFaces(*mesh.tiles[n], plan, splits, replaced);
    if (faces.back_facing == 0) {
      for (const TerrainFace& face : faces.front) node.faces.push_back(face.vertex);
    } else {
      // Turned the other way by convention: mirror and take them all.
      for (Vector3& p : plan) p.y = -p.y;
      for (const TerrainFace& face : terrainFaces(*mesh.tiles[n], plan, splits, replaced).front)
        node.faces.push_back(face.vertex);
    }
    for (const TerrainFace& face : stitcher.seamFaces(n, node.vertices, &node.seam_vertices))
      node.faces.push_back(face.vertex);
    mesh.nodes.push_back(std::move(node));
  }
  if (part == MeshPart::kInView) {
    for (std::size_t n = 0; n < mesh.cut.size(); ++n) {
      if (!mesh.cut[n].in_view) mesh.tiles[n].reset();
    }
  }
  return mesh;
}

std::string findCrack(const Database& database, const CutMesh& mesh) {
  const CutIndex index(database, mesh.cut);
  std::vector<Edge> edges;
  std::map<std::pair<std::uint16_t, Post>, Vector3> border_vertices;
  double doubled_area = 0, expected = 0;
  for (const MeshNode& node : mesh.nodes) {
    const NodeRecord& record = mesh.cut[node.cut_node].node.record;
    const TerrainTile& tile = *mesh.tiles[node.cut_node];
    const std::int64_t span =
        database.grid(record.grid).header().leaf_cells * (std::int64_t{1} << record.level);
    std::vector<bool> seen(node.posts.size(), false);
    for (const auto& face : node.faces) {
      std::int64_t turn = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Post &a = node.posts[face[k]], &b = node.posts[face[(k + 1) % 3]];
        if (a == b) return fmt::format("a face has an edge of no length at {}", nameOf(a));
        turn += a[0] * b[1] - b[0] * a[1];
        const std::uint64_t from = numberOf(record.grid, a), to = numberOf(record.grid, b);
        edges.push_back({std::min(from, to), std::max(from, to), from < to});
        const bool on_border = a[0] % span == 0 || a[1] % span == 0;
        if (!on_border || seen[face[k]]) continue;
        seen[face[k]] = true;
        const Vector3& position = node.vertices.position[face[k]];
        const auto [found, fresh] = border_vertices.emplace(std::pair{record.grid, a}, position);
        if (!fresh && !sameBits(found->second, position)) {
          return fmt::format("post {} stands at two places, {} m apart", nameOf(a),
                             length(found->second - position));
        }
      }
      if (turn <= 0) return fmt::format("a face at {} is turned over in plan", nameOf(node.posts[face[0]]));
      doubled_area += static_cast<double>(turn);
    }
    const double cell = std::ldexp(1.0, 2 * record.level);
    for (int j = 0; j + 1 < tile.rows; ++j) {
      for (int i = 0; i + 1 < tile.columns; ++i)
        expected +=
            cell * (static_cast<int>(tile.bottomFaceValid(i, j)) + static_cast<int>(tile.topFaceValid(i, j)));
    }
  }
  if (doubled_area != expected) return fmt::format("{} half cells are drawn, not {}", doubled_area, expected);
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Edge& edge = edges[k];
    const Post near = mesh.nodes.front().posts.front();
    Post from = postOf(edge.low, near), to = postOf(edge.high, near);
    if (k + 1 < edges.size() && edges[k + 1] == edge)
      return fmt::format("the edge {} {} is used twice in one direction", nameOf(from), nameOf(to));
    if (k + 1 < edges.size() && edges[k + 1].low == edge.low && edges[k + 1].high == edge.high) {
      ++k;
      continue;
    }
    // Nothing may be drawn on its right.
    if (!edge.forward) std::swap(from, to);
    const double dx = static_cast<double>(to[0] - from[0]), dy = static_cast<double>(to[1] - from[1]),
                 size = std::hypot(dx, dy);
    const double x = static_cast<double>(from[0] + to[0]) / 2 + dy / size * 1e-3,
                 y = static_cast<double>(from[1] + to[1]) / 2 - dx / size * 1e-3;
    if (drawnAt(mesh, index, static_cast<std::uint16_t>(edge.low >> 48), x, y)) {
      return fmt::format("nothing meets the edge {} {}, though something is drawn beyond it", nameOf(from),
                         nameOf(to));
    }
  }
  return {};
}

std::string findSeamCrack(const Database& database, const CutMesh& mesh) {
  const CutIndex index(database, mesh.cut);
  // A vertex's name: a post of a grid, or a point of a seam; where it stands, and its place on the ellipsoid.
  using Name = std::array<std::int64_t, 3>;
  struct Vertex {
    Name name{};
    Vector3 position, foot;
  };
  const auto foot_of_post = [&](std::uint16_t grid, std::int64_t column, std::int64_t row) {
    return database.grid(grid).placeAt(column, row).foot;
  };
  const auto vertex_of = [&](const MeshNode& node, std::uint32_t v) {
    const std::uint16_t grid = mesh.cut[node.cut_node].node.record.grid;
    if (v < node.posts.size()) {
      const Post& post = node.posts[v];
      return Vertex{
          {grid, post[0], post[1]}, node.vertices.position[v], foot_of_post(grid, post[0], post[1])};
    }
    const BorderStitcher::SeamVertexName& name = node.seam_vertices[v - node.posts.size()];
    const Seam& seam = database.seams()[name.seam];
    const SeamVertex& vertex = seam.vertices[name.vertex];
    const std::uint16_t of = vertex.side == SeamSide::kUpper ? seam.upper : seam.lower;
    const Vector3 p0 = foot_of_post(of, vertex.column, vertex.row);
    if (vertex.weight1 == 0 && vertex.weight2 == 0)
      return Vertex{{of, vertex.column, vertex.row}, node.vertices.position[v], p0};
    const Vector3 p1 = foot_of_post(of, vertex.column + vertex.to_p1[0], vertex.row + vertex.to_p1[1]);
    const Vector3 p2 = foot_of_post(of, vertex.column + vertex.to_p2[0], vertex.row + vertex.to_p2[1]);
    return Vertex{{-1 - static_cast<std::int64_t>(name.seam), name.vertex, 0},
                  node.vertices.position[v],
                  p0 + (p1 - p0) * vertex.weight1 + (p2 - p0) * vertex.weight2};
  };
  std::map<Name, Vertex> vertices;
  std::map<std::pair<Name, Name>, int> edges;
  for (const MeshNode& node : mesh.nodes) {
    for (const auto& face : node.faces) {
      const std::array<Vertex, 3> corner = {vertex_of(node, face[0]), vertex_of(node, face[1]),
                                            vertex_of(node, face[2])};
      const Vector3 normal = cross(corner[1].foot - corner[0].foot, corner[2].foot - corner[0].foot);
      // What is thinner than a hundredth of a millimetre may turn by rounding.
      if (dot(normal, corner[0].foot) <
          -1e-5 * length(corner[0].foot) * length(corner[1].foot - corner[0].foot))
        return fmt::format("a face at ({}, {}) is turned over in plan", corner[0].name[1], corner[0].name[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vertex &a = corner[k], &b = corner[(k + 1) % 3];
        if (a.name == b.name) return "a face has an edge of no length";
        if (++edges[{a.name, b.name}] > 1) return "an edge is used twice in one direction";
        const auto [found, fresh] = vertices.emplace(a.name, a);
        if (!fresh && !sameBits(found->second.position, a.position))
          return fmt::format("vertex {} {} {} stands at two places, {} m apart", a.name[0], a.name[1],
                             a.name[2], length(found->second.position - a.position));
      }
    }
  }
  for (const auto& [edge, uses] : edges) {
    if (edges.contains({edge.second, edge.first})) continue;
    const Vector3 &a = vertices.at(edge.first).foot, &b = vertices.at(edge.second).foot;
    const Vector3 middle = (a + b) * 0.5, right = normalized(cross(b - a, middle));
    for (int grid = 0; grid < database.gridCount(); ++grid) {
      const auto place = GridLocator(database.grid(grid)).locate(middle + right * 0.01);
      if (!place ||
          !drawnAt(mesh, index, static_cast<std::uint16_t>(grid),
                   static_cast<double>(place->column) + place->x, static_cast<double>(place->row) + place->y))
        continue;
      return fmt::format(
          "nothing meets the edge {} {} {} - {} {} {}, {:.3f} m long, though grid {} has ground "
          "beyond it",
          edge.first[0], edge.first[1], edge.first[2], edge.second[0], edge.second[1], edge.second[2],
          length(b - a), grid);
    }
  }
  return {};
}

FullResolution::FullResolution(const Database& database, int grid)
    : columns_(database.grid(grid).columnsAt(0)), rows_(database.grid(grid).rowsAt(0)) {
  heights_.assign(static_cast<std::size_t>(columns_.size() * rows_.size()), 0);
  valid_.assign(heights_.size(), 0);
  for (const Node& node : nodesOfLevel(database, grid, 0).value()) {
    const TerrainTile tile = database.terrain(node).value();
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i) {
        const auto at = static_cast<std::size_t>((tile.first_row + j - rows_.begin) * columns_.size() +
                                                 (tile.first_column + i - columns_.begin));
        heights_[at] = tile.height(i, j);
        valid_[at] = tile.isValid(i, j) ? 1 : 0;
      }
    }
  }
}

bool FullResolution::isValid(std::int64_t column, std::int64_t row) const {
  return valid_[static_cast<std::size_t>((row - rows_.begin) * columns_.size() +
                                         (column - columns_.begin))] != 0;
}
std::int32_t FullResolution::height(std::int64_t column, std::int64_t row) const {
  return heights_[static_cast<std::size_t>((row - rows_.begin) * columns_.size() +
                                           (column - columns_.begin))];
}

ContractFinding measureContract(const Database& database, const CutMesh& mesh, const FullResolution& full,
                                const ViewTransform& view) {
  ContractFinding finding;
  // Positions are in view space already; V and W carry the pixels.
  const auto to_view = [&](const Vector3& direction) {
    return Vector3{dot(view.forward, direction), dot(view.right, direction) * view.pixels,
                   dot(view.down, direction) * view.pixels};
  };
  const CutIndex index(database, mesh.cut);
  for (const MeshNode& node : mesh.nodes) {
    const CutNode& cut = mesh.cut[node.cut_node];
    if (!cut.in_view) continue;
    const GridGeometry& geometry = database.grid(cut.node.record.grid);
    const std::size_t own_posts =
        static_cast<std::size_t>(node.vertices.columns) * static_cast<std::size_t>(node.vertices.rows);
    const std::int64_t span = geometry.header().leaf_cells * (std::int64_t{1} << cut.node.record.level);
    const PostRange rows = geometry.rowsAt(0);
    const bool reaches_pole = geometry.isGeodetic() && (std::abs(geometry.latitude(rows.begin)) == 90 ||
                                                        std::abs(geometry.latitude(rows.end - 1)) == 90);
    if (cut.node.record.level == 0) {
      bool beside_coarser = false;
      for (const Side side : kSides) {
        const std::uint32_t across = index.acrossWhole(positionOf(cut.node.record), side);
        beside_coarser =
            beside_coarser || (across != CutIndex::kNone && mesh.cut[across].node.record.level > 0);
      }
      if (!beside_coarser) continue;  // full resolution, untouched
    }
    for (const auto& face : node.faces) {
      const Post &a = node.posts[face[0]], &b = node.posts[face[1]], &c = node.posts[face[2]];
      bool strip = false;
      for (const std::uint32_t vertex : face) {
        const Post& post = node.posts[vertex];
        strip = strip || vertex >= own_posts || post[0] % span == 0 || post[1] % span == 0;
      }
      const bool wall =
          reaches_pole && !coversGround(geometry.placeAt(a[0], a[1]).foot, geometry.placeAt(b[0], b[1]).foot,
                                        geometry.placeAt(c[0], c[1]).foot);
      const auto side_of = [](const Post& from, const Post& to, std::int64_t x, std::int64_t y) {
        return (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
      };
      const auto [west, east] = std::minmax({a[0], b[0], c[0]});
      const auto [south, north] = std::minmax({a[1], b[1], c[1]});
      for (std::int64_t y = south; y <= north; ++y) {
        for (std::int64_t x = west; x <= east; ++x) {
          if (side_of(a, b, x, y) < 0 || side_of(b, c, x, y) < 0 || side_of(c, a, x, y) < 0) continue;
          if (!full.isValid(x, y)) continue;
          const PostPlace place = geometry.placeAt(x, y);
          const Vector3 post = view.toView(place.at(geometry.metres(full.height(x, y))));
          if (post.x <= kHither || std::abs(post.y / post.x) > view.width / 2.0 ||
              std::abs(post.z / post.x) > view.height / 2.0)
            continue;
          const Vector3 up = to_view(place.up);
          const Vector3 drawn = meet(node, wall ? faceOver(node, post, up) : face, post, up).place;
          if (!std::isfinite(drawn.x)) continue;
          const double pixels = drawn.x > 0 ? std::hypot(drawn.y / drawn.x - post.y / post.x,
                                                         drawn.z / drawn.x - post.z / post.x)
                                            : HUGE_VAL;
          finding.worst_pixels = std::max(finding.worst_pixels, pixels);
          if (strip) finding.worst_strip_pixels = std::max(finding.worst_strip_pixels, pixels);
          ++finding.posts;
        }
      }
    }
  }
  return finding;
}

int viewsPerArea(int by_default) {
  const char* const wanted = std::getenv("DELTAZ_VIEWS");
  return wanted != nullptr ? std::atoi(wanted) : by_default;
}

std::string inWords(const Camera& camera) {
  return fmt::format("eye {:.9f},{:.9f},{:.4f} look {:.4f},{:.4f},{:.4f} fov {:.4f}", camera.eye.latitude,
                     camera.eye.longitude, camera.eye.height, camera.heading, camera.pitch, camera.roll,
                     camera.field_of_view);
}

Camera randomView(const Database& database, std::mt19937& random, int width, int height) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int kind = static_cast<int>(random() % 10);
  const double margin = kind == 0 ? 0.5 : 0;
  const double above = kind == 1   ? -uniform(0.1, 300)                  // in the ground
                       : kind == 2 ? std::pow(10.0, uniform(5, 7))       // far away
                       : kind == 3 ? 0.01                                // an ant's view
                                   : std::pow(10.0, uniform(0.2, 4.7));  // walkers and aircraft
  double pitch = uniform(-60, 15);
  if (kind == 2 || kind == 4) pitch = -90;
  if (kind == 5) pitch = 90;
  // One after the other: compilers choose the order of arguments themselves.
  const double heading = uniform(0, 360);
  const double y = uniform(-margin, 1 + margin), x = uniform(-margin, 1 + margin);
  Camera camera = cameraOver(database, x, y, above, heading, pitch, width, height);
  camera.eye.latitude = std::clamp(camera.eye.latitude, -90.0, 90.0);
  if (kind == 6) camera.eye.height = database.area().lowest_height - uniform(0, 500);  // under water
  camera.field_of_view = kind == 7 ? uniform(1, 10) : uniform(30, 110);
  camera.roll = kind == 8 ? uniform(-180, 180) : 0;
  return camera;
}

}  // namespace deltaz
