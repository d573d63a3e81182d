#include "tests/librender/drawn_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "librender/objects/report_objects.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

using Post = std::array<std::int64_t, 2>;

template <typename Value>
Value valueOf(Result<Value> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

// The part of a face in front of the hither plane: no corner, three or four.
std::vector<Vector3> clipped(const std::array<Vector3, 3>& corners) {
  std::vector<Vector3> kept;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 &a = corners[k], &b = corners[(k + 1) % 3];
    if (a.x >= kHither) kept.push_back(a);
    if ((a.x >= kHither) != (b.x >= kHither)) kept.push_back(a + (b - a) * ((kHither - a.x) / (b.x - a.x)));
  }
  return kept;
}

// The nearest face of each pixel.
struct Nearest {
  double inverse_depth = 0;
  bool from_below = false;
};

class TwoSidedBuffer {
 public:
  explicit TwoSidedBuffer(const ViewTransform& view)
      : view_(view), pixels_(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height)) {}

  void draw(const std::array<Vector3, 3>& corners, bool from_below) {
    const std::vector<Vector3> polygon = clipped(corners);
    for (std::size_t k = 2; k < polygon.size(); ++k)
      drawTriangle({polygon[0], polygon[k - 1], polygon[k]}, from_below);
  }

  std::vector<std::uint8_t> fromBelow() const {
    std::vector<std::uint8_t> flags;
    for (const Nearest& pixel : pixels_) flags.push_back(pixel.from_below ? 1 : 0);
    return flags;
  }

 private:
  void drawTriangle(const std::array<Vector3, 3>& corners, bool from_below) {
    std::array<double, 3> x{}, y{}, d{};
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = 1 / corners[k].x;
      x[k] = view_.centre_j + corners[k].y * d[k];
      y[k] = view_.centre_i + corners[k].z * d[k];
    }
    const auto side = [](double ax, double ay, double bx, double by, double px, double py) {
      return (bx - ax) * (py - ay) - (by - ay) * (px - ax);
    };
    const double area = side(x[0], y[0], x[1], y[1], x[2], y[2]);
    if (area == 0) return;
    const auto first = [](double a, double b, double c) {
      return static_cast<int>(std::ceil(std::max(0.0, std::min({a, b, c}))));
    };
    const auto last = [](double a, double b, double c, int size) {
      return static_cast<int>(std::floor(std::min(size - 1.0, std::max({a, b, c}))));
    };
    for (int i = first(y[0], y[1], y[2]); i <= last(y[0], y[1], y[2], view_.height); ++i) {
      for (int j = first(x[0], x[1], x[2]); j <= last(x[0], x[1], x[2], view_.width); ++j) {
        const double w0 = side(x[1], y[1], x[2], y[2], j, i) / area,
                     w1 = side(x[2], y[2], x[0], y[0], j, i) / area,
                     w2 = side(x[0], y[0], x[1], y[1], j, i) / area;
        if (!(w0 >= 0) || !(w1 >= 0) || !(w2 >= 0)) continue;
        put(static_cast<std::size_t>(i) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(j),
            w0 * d[0] + w1 * d[1] + w2 * d[2], from_below);
      }
    }
  }

  // At an edge between the two sides the upper one counts.
  void put(std::size_t pixel, double inverse_depth, bool from_below) {
    constexpr double kSame = 1e-9;
    Nearest& nearest = pixels_[pixel];
    if (inverse_depth > nearest.inverse_depth * (1 + kSame)) {
      nearest = {inverse_depth, from_below};
    } else if (inverse_depth >= nearest.inverse_depth * (1 - kSame)) {
      nearest.from_below = nearest.from_below && from_below;
    }
  }

  ViewTransform view_;
  std::vector<Nearest> pixels_;
};

// As wide as a tile, so far below the area's lowest post that chords of the largest tile do not reach it.
void addFloor(const Database& database, const TerrainTile& tile, const ViewTransform& view, Ground& ground) {
  constexpr double kDepth = 10000;  // metres
  const GridGeometry& geometry = database.grid(tile.grid);
  const std::int64_t step = std::int64_t{1} << tile.level;
  const auto corner = [&](int i, int j) {
    const PostPlace place = geometry.placeAt((tile.first_column + i) * step, (tile.first_row + j) * step);
    return view.toView(place.at(database.area().lowest_height - kDepth));
  };
  const Vector3 south_west = corner(0, 0), south_east = corner(tile.columns - 1, 0),
                north_east = corner(tile.columns - 1, tile.rows - 1), north_west = corner(0, tile.rows - 1);
  ground.floor.push_back({south_west, south_east, north_east});
  ground.floor.push_back({south_west, north_east, north_west});
}

}  // namespace

Ground groundOfCut(const Database& database, const CutMesh& mesh, const ViewTransform& view) {
  Ground ground;
  for (const MeshNode& node : mesh.nodes) {
    if (!mesh.cut[node.cut_node].in_view) continue;
    for (const auto& face : node.faces) {
      GroundFace& added = ground.faces.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        added.post[k] = node.posts[face[k]];
        added.position[k] = node.vertices.position[face[k]];
      }
    }
    addFloor(database, *mesh.tiles[node.cut_node], view, ground);
  }
  return ground;
}

Ground groundByRange(const Database& database, const ViewTransform& view, const ReportLod& lod) {
  Ground ground;
  const GridGeometry& geometry = database.grid(0);
  const ReportRanges ranges(lod, view, geometry);
  FrameStatistics::Nodes nodes;
  FrameStatistics::Objects objects;
  const Schedule schedule = valueOf(scheduleNodes(database, SeamIndex(database), view, {0}, nodes));
  for (const CutNode& node : schedule.nodes) {
    if (!node.in_view) continue;
    const TerrainTile tile = valueOf(database.terrain(node.node));
    const std::vector<Vector3> position = terrainPositions(tile, geometry, view);
    // Faces looked at in plan from above are all front faces.
    std::vector<Vector3> plan;
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i)
        plan.push_back({1, -static_cast<double>(i), static_cast<double>(j)});
    }
    const TerrainFaces faces = reportFaces(tile, plan, reportObjects(tile, position, view, ranges), objects);
    const auto columns = static_cast<std::uint32_t>(tile.columns);
    for (const TerrainFace& face : faces.front) {
      GroundFace& added = ground.faces.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        added.post[k] = {tile.first_column + face.vertex[k] % columns,
                         tile.first_row + face.vertex[k] / columns};
        added.position[k] = position[face.vertex[k]];
      }
    }
    addFloor(database, tile, view, ground);
  }
  return ground;
}

std::vector<std::uint8_t> seenFromBelow(const Ground& ground, const ViewTransform& view) {
  TwoSidedBuffer buffer(view);
  for (const GroundFace& face : ground.faces) {
    const auto& [a, b, c] = face.position;
    buffer.draw(face.position, isBackFacing(a, b, c));
  }
  for (const std::array<Vector3, 3>& face : ground.floor) buffer.draw(face, true);
  return buffer.fromBelow();
}

double largestDisplacement(const Database& database, const std::vector<GroundFace>& faces,
                           const FullResolution& full, const ViewTransform& view) {
  const GridGeometry& geometry = database.grid(0);
  double largest = 0;
  for (const GroundFace& face : faces) {
    const auto& [a, b, c] = face.post;
    const auto [west, east] = std::minmax({a[0], b[0], c[0]});
    const auto [south, north] = std::minmax({a[1], b[1], c[1]});
    if (east - west <= 1 && north - south <= 1) continue;  // no posts but its own
    const auto side_of = [](const Post& from, const Post& to, std::int64_t x, std::int64_t y) {
      return (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
    };
    const Vector3& corner = face.position[0];
    const Vector3 normal = cross(face.position[1] - corner, face.position[2] - corner);
    for (std::int64_t y = south; y <= north; ++y) {
      for (std::int64_t x = west; x <= east; ++x) {
        if (side_of(a, b, x, y) < 0 || side_of(b, c, x, y) < 0 || side_of(c, a, x, y) < 0) continue;
        if (!full.isValid(x, y)) continue;
        const PostPlace place = geometry.placeAt(x, y);
        const Vector3 post = view.toView(place.at(geometry.metres(full.height(x, y))));
        if (post.x <= kHither || std::abs(post.y / post.x) > view.width / 2.0 ||
            std::abs(post.z / post.x) > view.height / 2.0)
          continue;
        const Vector3 up = {dot(view.forward, place.up), dot(view.right, place.up) * view.pixels,
                            dot(view.down, place.up) * view.pixels};
        const Vector3 drawn = post + up * (dot(normal, corner - post) / dot(normal, up));
        if (!(drawn.x > 0)) return std::numeric_limits<double>::infinity();
        largest = std::max(
            largest, std::hypot(drawn.y / drawn.x - post.y / post.x, drawn.z / drawn.x - post.z / post.x));
      }
    }
  }
  return largest;
}

std::uint64_t unmatchedEdges(const std::vector<GroundFace>& faces) {
  if (faces.empty()) return 0;
  Post low = faces.front().post[0], high = low;
  for (const GroundFace& face : faces) {
    for (const Post& post : face.post) {
      low = {std::min(low[0], post[0]), std::min(low[1], post[1])};
      high = {std::max(high[0], post[0]), std::max(high[1], post[1])};
    }
  }
  const std::int64_t columns = high[0] - low[0] + 1, rows = high[1] - low[1] + 1;
  const auto number = [&](const Post& post) {
    return static_cast<std::uint64_t>((post[1] - low[1]) * columns + (post[0] - low[0]));
  };
  // Level-0 cells under some face.
  std::vector<bool> covered(static_cast<std::size_t>(columns * rows), false);
  struct Edge {
    std::uint64_t from = 0, to = 0;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (const GroundFace& face : faces) {
    const auto& [a, b, c] = face.post;
    for (std::int64_t row = std::min({a[1], b[1], c[1]}); row < std::max({a[1], b[1], c[1]}); ++row) {
      for (std::int64_t column = std::min({a[0], b[0], c[0]}); column < std::max({a[0], b[0], c[0]});
           ++column)
        covered[number({column, row})] = true;
    }
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({number(face.post[k]), number(face.post[(k + 1) % 3])});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::uint64_t unmatched = 0;
  for (const Edge& edge : edges) {
    if (std::binary_search(edges.begin(), edges.end(), Edge{edge.to, edge.from})) continue;
    // The cell on its right. Edges inside a cell, diagonals, are the same in both faces of the cell.
    const auto index = static_cast<std::int64_t>(edge.from), next = static_cast<std::int64_t>(edge.to);
    const Post from = {index % columns, index / columns}, to = {next % columns, next / columns};
    const std::int64_t dx = to[0] - from[0], dy = to[1] - from[1];
    std::int64_t column = std::min(from[0], to[0]), row = std::min(from[1], to[1]);
    if (dx == 0) {
      column += dy > 0 ? 0 : -1;
    } else if (dy == 0) {
      row += dx > 0 ? -1 : 0;
    }
    if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
    if (covered[static_cast<std::size_t>(row * columns + column)]) ++unmatched;
  }
  return unmatched;
}

}  // namespace deltaz
