#include "libdb/build/seam_builder.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <unordered_map>

#include "libdb/access/grid_locator.h"
#include "libdb/build/face_cutter.h"

namespace deltaz {

namespace {

using Post = std::array<std::int64_t, 2>;  // global level-0 index
constexpr std::uint32_t kNoVertex = 0xFFFFFFFF;

struct PostHash {
  std::size_t operator()(const Post& post) const {
    const auto a = static_cast<std::uint64_t>(post[0]), b = static_cast<std::uint64_t>(post[1]);
    return static_cast<std::size_t>((a * 0x9E3779B97F4A7C15u) ^
                                    (b + (a << 7) + (b >> 3) * 0xC2B2AE3D27D4EB4Fu));
  }
};

// A face of a grid; ordered by row, column, bottom before top.
struct Face {
  std::int64_t row = 0, column = 0;
  bool top = false;
  auto operator<=>(const Face&) const = default;
};

// A grid's posts by global index.
class GridPosts {
 public:
  GridPosts(const RawGrid& grid, const GridGeometry& geometry) : grid_(grid), geometry_(geometry) {}

  const GridGeometry& geometry() const { return geometry_; }
  PostRange columns() const { return geometry_.columnsAt(0); }
  PostRange rows() const { return geometry_.rowsAt(0); }
  bool isValid(std::int64_t column, std::int64_t row) const {
    return column >= columns().begin && column < columns().end && row >= rows().begin && row < rows().end &&
           grid_.isValid(column - columns().begin, row - rows().begin);
  }
  bool isValid(const Face& face) const {
    return isValid(face.column, face.row) && isValid(face.column + 1, face.row + 1) &&
           (face.top ? isValid(face.column, face.row + 1) : isValid(face.column + 1, face.row));
  }
  Vector3 position(std::int64_t column, std::int64_t row) const {
    const double height = geometry_.metres(grid_.height(column - columns().begin, row - rows().begin));
    return geometry_.placeAt(column, row).at(height);
  }

 private:
  const RawGrid& grid_;
  const GridGeometry& geometry_;
};

// What the edge of the upper grid does to one lower face.
struct TouchedFace {
  // Vertices on its edges in the order of its corners: first to second, second to third, third to first; with
  // the place along the edge.
  std::array<std::vector<std::pair<double, std::uint32_t>>, 3> on_edge;
  std::vector<std::uint32_t> inside;
  std::vector<std::array<std::uint32_t, 2>> lines;
};

class SeamMaker {
 public:
  SeamMaker(const GridPosts& upper, const GridPosts& lower)
      : upper_(upper), lower_(lower), lower_locator_(lower.geometry()), upper_locator_(upper.geometry()) {}

  Result<std::optional<Seam>> run() {
    followEdge();
    if (moved_.empty()) return std::optional<Seam>{};
    DELTAZ_TRY(cutLowerFaces());
    removeCoveredFaces();
    replaceUpperFaces();
    measureError();
    return std::optional<Seam>{std::move(seam_)};
  }

 private:
  // ---- vertices

  std::uint32_t addVertex(const SeamVertex& vertex) {
    seam_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(seam_.vertices.size() - 1);
  }

  std::uint32_t upperPost(const Post& post) {
    const auto [found, fresh] = upper_posts_.emplace(post, kNoVertex);
    if (fresh) {
      SeamVertex vertex;
      vertex.side = SeamSide::kUpper;
      vertex.column = post[0];
      vertex.row = post[1];
      found->second = addVertex(vertex);
    }
    return found->second;
  }

  // The vertex at a place of the lower grid; on edges and posts it depends on those alone.
  std::uint32_t lowerVertex(const GridPlace& place) {
    const auto key = std::pair{Post{place.column, place.row}, std::array{place.x, place.y}};
    const auto [found, fresh] = lower_vertices_.emplace(key, kNoVertex);
    if (!fresh) return found->second;
    SeamVertex vertex;
    vertex.column = place.column;
    vertex.row = place.row;
    if (place.x == place.y) {
      vertex.to_p1 = {1, 1};
      vertex.weight1 = place.x;
      if (place.x == 0) vertex.to_p1 = {0, 0};
    } else if (place.y == 0) {
      vertex.to_p1 = {1, 0};
      vertex.weight1 = place.x;
    } else if (place.x == 0) {
      vertex.to_p1 = {0, 1};
      vertex.weight1 = place.y;
    } else if (place.x > place.y) {
      vertex.to_p1 = {1, 0};
      vertex.to_p2 = {1, 1};
      vertex.weight1 = place.x - place.y;
      vertex.weight2 = place.y;
    } else {
      vertex.to_p1 = {1, 1};
      vertex.to_p2 = {0, 1};
      vertex.weight1 = place.x;
      vertex.weight2 = place.y - place.x;
    }
    found->second = addVertex(vertex);
    places_.emplace(found->second, place);
    touch(found->second, place);
    return found->second;
  }

  // Notes a lower vertex with the faces whose edges or inside it lies on. Corners change nothing.
  void touch(std::uint32_t vertex, const GridPlace& place) {
    const Face bottom{place.row, place.column, false}, top{place.row, place.column, true};
    const auto on_edge = [&](const Face& face, std::size_t edge, double along) {
      if (lower_.isValid(face)) touched_[face].on_edge[edge].emplace_back(along, vertex);
    };
    if (place.x == 0 && place.y == 0) return;
    if (place.x == place.y) {
      on_edge(bottom, 2, 1 - place.x);  // NE to SW
      on_edge(top, 0, place.x);         // SW to NE
    } else if (place.y == 0) {
      on_edge(bottom, 0, place.x);                                   // SW to SE
      on_edge({place.row - 1, place.column, true}, 1, 1 - place.x);  // NE to NW
    } else if (place.x == 0) {
      on_edge(top, 2, 1 - place.y);                               // NW to SW
      on_edge({place.row, place.column - 1, false}, 1, place.y);  // SE to NE
    } else {
      const Face& face = place.x > place.y ? bottom : top;
      if (lower_.isValid(face)) touched_[face].inside.push_back(vertex);
    }
  }

  // ---- the edge of the upper grid's coverage

  const std::optional<GridPlace>& placeOf(const Post& post) {
    const auto [found, fresh] = post_places_.emplace(post, std::nullopt);
    if (fresh) found->second = lower_locator_.locatePost(upper_.geometry(), post[0], post[1]);
    return found->second;
  }

  // The valid lower faces whose closure holds a place.
  std::vector<Face> facesAt(const GridPlace& place) const {
    std::vector<Face> faces;
    const auto add = [&](std::int64_t row, std::int64_t column, bool top) {
      if (const Face face{row, column, top}; lower_.isValid(face)) faces.push_back(face);
    };
    const std::int64_t row = place.row, column = place.column;
    if (place.x == 0 && place.y == 0) {
      for (const bool top : {false, true}) {
        add(row, column, top);
        add(row - 1, column - 1, top);
      }
      add(row, column - 1, false);
      add(row - 1, column, true);
    } else {
      if (place.x >= place.y) add(row, column, false);
      if (place.x <= place.y) add(row, column, true);
      if (place.y == 0) add(row - 1, column, true);
      if (place.x == 0) add(row, column - 1, false);
    }
    return faces;
  }

  void followEdge() {
    const PostRange columns = upper_.columns(), rows = upper_.rows();
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
      for (std::int64_t column = columns.begin; column < columns.end; ++column) {
        const Post here{column, row};
        const auto valid = [&](std::int64_t r, std::int64_t c, bool top) {
          return upper_.isValid(Face{r, c, top});
        };
        // The faces on the left and on the right of the edges eastwards, northwards and across.
        followIfEdge(here, {column + 1, row}, valid(row, column, false), valid(row - 1, column, true));
        followIfEdge(here, {column, row + 1}, valid(row, column - 1, false), valid(row, column, true));
        followIfEdge(here, {column + 1, row + 1}, valid(row, column, true), valid(row, column, false));
      }
    }
  }

  void followIfEdge(const Post& from, const Post& to, bool left, bool right) {
    if (left == right) return;
    // Directed so that the upper grid lies on the left.
    left ? follow(from, to) : follow(to, from);
  }

  void follow(const Post& from, const Post& to) {
    const std::optional<GridPlace>&a = placeOf(from), &b = placeOf(to);
    if (!a || !b) return;
    move(from, *a);
    move(to, *b);
    const std::vector<GridPlace> path = crossings(*a, *b);
    std::vector<std::uint32_t>& splits = splits_[{from, to}];
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const Stretch stretch = stretchOver(path[k], path[k + 1]);
      if (!stretch.over_ground) continue;
      const std::uint32_t begin = lowerVertex(path[k]), end = lowerVertex(path[k + 1]);
      if (k > 0 && (splits.empty() || splits.back() != begin)) splits.push_back(begin);
      if (k + 2 < path.size()) splits.push_back(end);
      if (!stretch.on_edge) touched_[stretch.face].lines.push_back({begin, end});
    }
    if (splits.empty()) splits_.erase({from, to});
  }

  // An edge post over the lower grid stands on the lower grid's surface.
  void move(const Post& post, const GridPlace& place) {
    if (moved_.contains(post) || facesAt(place).empty()) return;
    const std::uint32_t vertex = lowerVertex(place);
    moved_.emplace(post, vertex);
  }

  // What lies under the line between two places with no crossing between them.
  struct Stretch {
    bool over_ground = false, on_edge = false;
    Face face;  // if not on an edge
  };
  Stretch stretchOver(const GridPlace& a, const GridPlace& b) const {
    const std::int64_t column = std::min(a.column, b.column), row = std::min(a.row, b.row);
    const double ax = static_cast<double>(a.column - column) + a.x,
                 ay = static_cast<double>(a.row - row) + a.y;
    const double bx = static_cast<double>(b.column - column) + b.x,
                 by = static_cast<double>(b.row - row) + b.y;
    const double x = (ax + bx) / 2, y = (ay + by) / 2, i = std::floor(x), j = std::floor(y);
    // Both ends on one line of the grid, exactly: so is what lies between.
    const auto on_line = [](double from, double to) { return from == to && from == std::floor(from); };
    Stretch stretch;
    stretch.on_edge = on_line(ax, bx) || on_line(ay, by) || on_line(ax - ay, bx - by);
    if (stretch.on_edge) {
      GridPlace middle = GridLocator::snapped(x, y);
      middle.column += column;
      middle.row += row;
      stretch.over_ground = !facesAt(middle).empty();
    } else {
      stretch.face = {row + static_cast<std::int64_t>(j), column + static_cast<std::int64_t>(i),
                      y - j > x - i};
      stretch.over_ground = lower_.isValid(stretch.face);
    }
    return stretch;
  }

  // The places where the line from a to b crosses the lower grid's lines and diagonals, the ends included.
  static std::vector<GridPlace> crossings(const GridPlace& a, const GridPlace& b) {
    // Relative to a's cell, so that fractions keep their bits.
    const double bx = static_cast<double>(b.column - a.column) + b.x,
                 by = static_cast<double>(b.row - a.row) + b.y;
    std::vector<double> at;
    const auto cross_lines = [&](double from, double to) {
      const double low = std::min(from, to), high = std::max(from, to);
      for (double line = std::floor(low) + 1; line < high; line += 1)
        at.push_back((line - from) / (to - from));
    };
    cross_lines(a.x, bx);
    cross_lines(a.y, by);
    cross_lines(a.x - a.y, bx - by);
    std::sort(at.begin(), at.end());
    std::vector<GridPlace> path = {a};
    const auto append = [&](GridPlace place) {
      if (place == path.back() || place == b) return;
      path.push_back(place);
    };
    for (const double t : at) {
      GridPlace place = GridLocator::snapped(a.x + t * (bx - a.x), a.y + t * (by - a.y));
      place.column += a.column;
      place.row += a.row;
      append(place);
    }
    path.push_back(b);
    return path;
  }

  // ---- lower faces

  std::array<GridPlace, 3> cornersOf(const Face& face) const {
    const GridPlace south_west{face.column, face.row, 0, 0}, north_east{face.column + 1, face.row + 1, 0, 0};
    if (face.top) return {south_west, north_east, GridPlace{face.column, face.row + 1, 0, 0}};
    return {south_west, GridPlace{face.column + 1, face.row, 0, 0}, north_east};
  }

  CutPoint cutPoint(const Face& face, std::uint32_t vertex) const {
    const GridPlace& place = places_.at(vertex);
    return {static_cast<double>(place.column - face.column) + place.x,
            static_cast<double>(place.row - face.row) + place.y, vertex};
  }

  bool isUnderUpper(const Face& face) const {
    const std::array<GridPlace, 3> corners = cornersOf(face);
    Vector3 middle;
    for (const GridPlace& corner : corners)
      middle = middle + lower_.geometry().placeAt(corner.column, corner.row).foot;
    const std::optional<GridPlace> place = upper_locator_.locate(middle * (1.0 / 3.0));
    return place && upper_.isValid(Face{place->row, place->column, place->y > place->x});
  }

  Status cutLowerFaces() {
    // Corners become vertices only now, which adds none to touched_.
    for (auto& [face, touched] : touched_) {
      std::vector<CutPoint> border, inner;
      const std::array<GridPlace, 3> corners = cornersOf(face);
      for (std::size_t k = 0; k < 3; ++k) {
        border.push_back(cutPoint(face, lowerVertex(corners[k])));
        std::sort(touched.on_edge[k].begin(), touched.on_edge[k].end());
        for (const auto& [along, vertex] : touched.on_edge[k]) border.push_back(cutPoint(face, vertex));
      }
      for (const std::uint32_t vertex : touched.inside) inner.push_back(cutPoint(face, vertex));
      if (border.size() == 3 && inner.empty() && touched.lines.empty()) continue;
      const auto triangles = cutFace(border, inner, touched.lines);
      if (!triangles) {
        return invalidError(IssueCode::kNone, "sources", "two grids cannot be joined",
                            "the edge of one crosses itself over the other",
                            "Resample one of them onto the other's grid (--grid)");
      }
      ReplacedFace replaced{face.column, face.row, face.top, static_cast<std::uint32_t>(seam_.faces.size()),
                            0};
      const bool under = isUnderUpper(face);
      for (const CutTriangle& triangle : *triangles) {
        if (triangle.part == CutPart::kInside || (triangle.part == CutPart::kUndecided && under)) continue;
        seam_.faces.push_back(triangle.corners);
        ++replaced.face_count;
      }
      seam_.replaced[1].push_back(replaced);
    }
    return Success{};
  }

  // Lower faces that no edge touches lie under the upper grid altogether, or not at all.
  void removeCoveredFaces() {
    std::int64_t first_row = INT64_MAX, last_row = INT64_MIN, first_column = INT64_MAX,
                 last_column = INT64_MIN;
    for (const auto& [post, place] : post_places_) {
      if (!place) continue;
      first_row = std::min(first_row, place->row);
      last_row = std::max(last_row, place->row);
      first_column = std::min(first_column, place->column);
      last_column = std::max(last_column, place->column);
    }
    const PostRange columns = lower_.columns(), rows = lower_.rows();
    first_row = std::max(first_row - 1, rows.begin);
    first_column = std::max(first_column - 1, columns.begin);
    last_row = std::min(last_row + 1, rows.end - 2);
    last_column = std::min(last_column + 1, columns.end - 2);
    std::vector<ReplacedFace> removed;
    for (std::int64_t row = first_row; row <= last_row; ++row) {
      for (std::int64_t column = first_column; column <= last_column; ++column) {
        // A void face needs no removing: its cell may still be part of a run.
        std::array<bool, 2> gone{}, drawn{};
        for (const bool top : {false, true}) {
          const Face face{row, column, top};
          drawn[top ? 1 : 0] = lower_.isValid(face);
          gone[top ? 1 : 0] = drawn[top ? 1 : 0] && !touched_.contains(face) && isUnderUpper(face);
        }
        if (!gone[0] && !gone[1]) continue;
        if ((gone[0] || !drawn[0]) && (gone[1] || !drawn[1])) {
          if (!seam_.runs.empty() && seam_.runs.back().row == row && seam_.runs.back().end == column) {
            ++seam_.runs.back().end;
          } else {
            seam_.runs.push_back({row, column, column + 1});
          }
          continue;
        }
        for (const bool top : {false, true}) {
          if (gone[top ? 1 : 0]) removed.push_back({column, row, top, 0, 0});
        }
      }
    }
    auto& replaced = seam_.replaced[1];
    replaced.insert(replaced.end(), removed.begin(), removed.end());
    std::sort(replaced.begin(), replaced.end(), [](const ReplacedFace& a, const ReplacedFace& b) {
      return Face{a.row, a.column, a.top} < Face{b.row, b.column, b.top};
    });
  }

  // ---- upper faces

  std::uint32_t upperVertex(const Post& post) {
    const auto moved = moved_.find(post);
    return moved != moved_.end() ? moved->second : upperPost(post);
  }

  void replaceUpperFaces() {
    std::map<Face, bool> touched;
    for (const auto& [post, vertex] : moved_) {
      const auto [column, row] = post;
      for (const Face& face :
           {Face{row, column, false}, Face{row, column, true}, Face{row - 1, column - 1, false},
            Face{row - 1, column - 1, true}, Face{row, column - 1, false}, Face{row - 1, column, true}})
        touched[face] = true;
    }
    // An edge may be split though its ends lie beyond the lower grid; it has one valid face.
    for (const auto& [edge, vertices] : splits_) {
      const std::int64_t column = std::min(edge[0][0], edge[1][0]), row = std::min(edge[0][1], edge[1][1]);
      for (const Face& face : {Face{row, column, false}, Face{row, column, true},
                               Face{row, column - 1, false}, Face{row - 1, column, true}})
        touched[face] = true;
    }
    for (const auto& [face, unused] : touched) {
      if (upper_.isValid(face)) replaceUpperFace(face);
    }
  }

  void replaceUpperFace(const Face& face) {
    const Post south_west{face.column, face.row}, north_east{face.column + 1, face.row + 1};
    std::array<Post, 3> posts = {south_west, north_east, Post{face.column, face.row + 1}};
    if (!face.top) posts = {south_west, Post{face.column + 1, face.row}, north_east};
    std::array<std::uint32_t, 3> corner{};
    std::array<std::vector<std::uint32_t>, 3> on_edge;
    bool changed = false;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = upperVertex(posts[k]);
      changed = changed || moved_.contains(posts[k]);
      // The edge is directed with the upper grid on its left, as the face's own edges are.
      const auto found = splits_.find({posts[k], posts[(k + 1) % 3]});
      if (found == splits_.end()) continue;
      on_edge[k] = found->second;
      changed = true;
    }
    if (!changed) return;
    ReplacedFace replaced{face.column, face.row, face.top, static_cast<std::uint32_t>(seam_.faces.size()), 0};
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      // Posts that moved onto one point leave nothing between them.
      if (a == b || b == c || c == a) return;
      seam_.faces.push_back({a, b, c});
      ++replaced.face_count;
    };
    // Begin with an edge that has points, if any: c's fan through them, then fans for the other edges.
    std::size_t first = 0;
    while (first < 2 && on_edge[first].empty()) ++first;
    const std::uint32_t a = corner[first], b = corner[(first + 1) % 3], c = corner[(first + 2) % 3];
    const auto &ab = on_edge[first], &bc = on_edge[(first + 1) % 3], &ca = on_edge[(first + 2) % 3];
    const auto fan = [&](std::uint32_t apex, std::uint32_t from, const std::vector<std::uint32_t>& points,
                         std::uint32_t to) {
      for (const std::uint32_t point : points) {
        add(apex, from, point);
        from = point;
      }
      add(apex, from, to);
    };
    if (ab.empty()) {
      add(a, b, c);
    } else {
      fan(ab.front(), c, ca, a);
      for (std::size_t k = 0; k + 1 < ab.size(); ++k) add(c, ab[k], ab[k + 1]);
      fan(ab.back(), b, bc, c);
    }
    seam_.replaced[0].push_back(replaced);
  }

  // ---- the error

  void measureError() {
    for (const auto& [post, vertex] : moved_) {
      const SeamVertex& lower = seam_.vertices[vertex];
      const Vector3 p0 = lower_.position(lower.column, lower.row);
      Vector3 surface = p0;
      if (lower.weight1 != 0)
        surface =
            surface +
            (lower_.position(lower.column + lower.to_p1[0], lower.row + lower.to_p1[1]) - p0) * lower.weight1;
      if (lower.weight2 != 0)
        surface =
            surface +
            (lower_.position(lower.column + lower.to_p2[0], lower.row + lower.to_p2[1]) - p0) * lower.weight2;
      const Vector3 up = upper_.geometry().placeAt(post[0], post[1]).up;
      seam_.error = std::max(seam_.error, std::abs(dot(upper_.position(post[0], post[1]) - surface, up)));
    }
  }

  const GridPosts &upper_, &lower_;
  GridLocator lower_locator_, upper_locator_;
  Seam seam_;
  std::unordered_map<Post, std::optional<GridPlace>, PostHash> post_places_;
  std::unordered_map<Post, std::uint32_t, PostHash> upper_posts_;
  std::map<Post, std::uint32_t> moved_;  // edge posts that stand on the lower grid, with their vertices
  std::map<std::array<Post, 2>, std::vector<std::uint32_t>> splits_;
  std::map<std::pair<Post, std::array<double, 2>>, std::uint32_t> lower_vertices_;
  std::unordered_map<std::uint32_t, GridPlace> places_;
  std::map<Face, TouchedFace> touched_;
};

}  // namespace

Result<std::optional<Seam>> makeSeam(const RawGrid& upper_grid, std::uint16_t upper,
                                     const RawGrid& lower_grid, std::uint16_t lower) {
  const GridGeometry upper_geometry(upper_grid.header, upper_grid.patches);
  const GridGeometry lower_geometry(lower_grid.header, lower_grid.patches);
  const GridPosts upper_posts(upper_grid, upper_geometry), lower_posts(lower_grid, lower_geometry);
  DELTAZ_TRY_ASSIGN(std::optional<Seam> seam, SeamMaker(upper_posts, lower_posts).run());
  if (seam) {
    seam->upper = upper;
    seam->lower = lower;
  }
  return seam;
}

}  // namespace deltaz
