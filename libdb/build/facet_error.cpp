#include "libdb/build/facet_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace deltaz {

namespace {

// How far outside a facet, in barycentric terms, a post may lie before its neighbour is looked at.
constexpr double kInsideTolerance = 1e-9;
// Sine of the angle between two edges at which a facet counts as having no extent.
constexpr double kDegenerate = 1e-12;

// Positions of the coarse posts around a leaf.
class CoarseWindow {
 public:
  CoarseWindow(const RawGrid& grid, const GridGeometry& geometry, int level, PostRange columns,
               PostRange rows)
      : columns_(columns), rows_(rows) {
    const std::int64_t step = std::int64_t{1} << level;
    const std::vector<PostPlace> places = geometry.postPlaces(level, columns, rows);
    positions_.resize(static_cast<std::size_t>(columns.size() * rows.size()));
    valid_.assign(positions_.size(), 0);
    for (std::int64_t J = rows.begin; J < rows.end; ++J) {
      const std::int64_t row = J * step - grid.header.y_axis.first;
      if (row < 0 || row >= grid.header.y_axis.count) continue;
      for (std::int64_t I = columns.begin; I < columns.end; ++I) {
        const std::int64_t column = I * step - grid.header.x_axis.first;
        if (column < 0 || column >= grid.header.x_axis.count || !grid.isValid(column, row)) continue;
        positions_[index(I, J)] = places[index(I, J)].at(geometry.metres(grid.height(column, row)));
        valid_[index(I, J)] = 1;
      }
    }
  }

  bool isValid(std::int64_t I, std::int64_t J) const {
    return I >= columns_.begin && I < columns_.end && J >= rows_.begin && J < rows_.end &&
           valid_[index(I, J)] != 0;
  }
  const Vector3& position(std::int64_t I, std::int64_t J) const { return positions_[index(I, J)]; }

 private:
  std::size_t index(std::int64_t I, std::int64_t J) const {
    return static_cast<std::size_t>((J - rows_.begin) * columns_.size() + (I - columns_.begin));
  }
  PostRange columns_, rows_;
  std::vector<Vector3> positions_;
  std::vector<std::uint8_t> valid_;
};

struct Facet {
  std::int64_t I = 0, J = 0;  // cell, by its south-west post
  bool top = false;           // (SW, NE, NW) instead of (SW, SE, NE)

  // The facet across the edge that lies opposite vertex `vertex` (0, 1, 2 in the order above).
  Facet across(int vertex) const {
    if (!top) {
      if (vertex == 0) return {I + 1, J, true};
      if (vertex == 1) return {I, J, true};
      return {I, J - 1, true};
    }
    if (vertex == 0) return {I, J + 1, false};
    if (vertex == 1) return {I - 1, J, false};
    return {I, J, false};
  }
  bool isValid(const CoarseWindow& window) const {
    return window.isValid(I, J) && window.isValid(I + 1, J + 1) &&
           (top ? window.isValid(I, J + 1) : window.isValid(I + 1, J));
  }
};

struct Pierce {
  double height = 0;  // of the facet's plane above the ellipsoid, along the normal
  double inside = -std::numeric_limits<double>::infinity();  // smallest barycentric coordinate; >= 0 inside
  int nearest_vertex_across = 0;                             // whose barycentric coordinate it is
  bool valid = false;
};

// Where the line foot + t * up meets the facet's plane (Moeller and Trumbore 1997).
Pierce pierce(const CoarseWindow& window, const Facet& facet, const Vector3& foot, const Vector3& up) {
  Pierce result;
  if (!facet.isValid(window)) return result;
  const Vector3& v0 = window.position(facet.I, facet.J);
  const Vector3& v1 =
      facet.top ? window.position(facet.I + 1, facet.J + 1) : window.position(facet.I + 1, facet.J);
  const Vector3& v2 =
      facet.top ? window.position(facet.I, facet.J + 1) : window.position(facet.I + 1, facet.J + 1);
  const Vector3 e1 = v1 - v0;
  const Vector3 e2 = v2 - v0;
  const Vector3 p = cross(up, e2);
  const double determinant = dot(e1, p);
  if (std::abs(determinant) <= kDegenerate * length(e1) * length(e2)) return result;
  const Vector3 s = foot - v0;
  const Vector3 q = cross(s, e1);
  const double b1 = dot(s, p) / determinant;
  const double b2 = dot(up, q) / determinant;
  const std::array<double, 3> barycentric = {1 - b1 - b2, b1, b2};
  const auto smallest = std::min_element(barycentric.begin(), barycentric.end());
  result.inside = *smallest;
  result.nearest_vertex_across = static_cast<int>(smallest - barycentric.begin());
  result.height = dot(e2, q) / determinant;
  result.valid = true;
  return result;
}

// The plan facets whose closure holds fine post (column, row): one, or two if the post lies on an edge
// between them.
int planFacets(std::int64_t column, std::int64_t row, std::int64_t step, std::array<Facet, 2>& facets) {
  const std::int64_t I = floorDivide(column, step);
  const std::int64_t J = floorDivide(row, step);
  const std::int64_t dx = column - I * step;
  const std::int64_t dy = row - J * step;
  if (dx == dy) {
    facets = {{{I, J, false}, {I, J, true}}};
    return 2;
  }
  if (dy == 0) {
    facets = {{{I, J, false}, {I, J - 1, true}}};
    return 2;
  }
  if (dx == 0) {
    facets = {{{I, J, true}, {I - 1, J, false}}};
    return 2;
  }
  facets[0] = {I, J, dy > dx};
  return 1;
}

// Where the coarse surface lies over a post; invalid if none is drawn there in plan.
Pierce coarseSurfaceAt(const CoarseWindow& window, std::int64_t column, std::int64_t row, std::int64_t step,
                       const Vector3& foot, const Vector3& up) {
  std::array<Facet, 2> candidates;
  const int count = planFacets(column, row, step, candidates);
  Pierce best;
  Facet facet = candidates[0];
  bool drawn = false;
  const auto consider = [&](const Facet& candidate) {
    const Pierce hit = pierce(window, candidate, foot, up);
    if (!hit.valid || hit.inside <= best.inside) return false;
    best = hit;
    facet = candidate;
    return true;
  };
  for (int i = 0; i < count; ++i) {
    drawn = drawn || candidates[static_cast<std::size_t>(i)].isValid(window);
    consider(candidates[static_cast<std::size_t>(i)]);
  }
  if (!drawn) return {};
  // The edges of facets bow in plan, so the facet that is met may be the next one.
  for (int steps = 0; best.valid && best.inside < -kInsideTolerance && steps < 4; ++steps) {
    if (!consider(facet.across(best.nearest_vertex_across))) break;
  }
  if (best.valid && best.inside >= -kInsideTolerance) return best;
  // Beside a pole, where a row is one point, facets stand upright or have no extent, and across an edge lies
  // nothing to go by.
  const std::int64_t I = candidates[0].I, J = candidates[0].J;
  for (std::int64_t j = J - 1; j <= J + 1; ++j) {
    for (std::int64_t i = I - 1; i <= I + 1; ++i) {
      consider({i, j, false});
      consider({i, j, true});
    }
  }
  return best;
}

// Adds a square, or makes the sum the largest number there is: errors of kilometres at every post of a leaf.
void addSquare(std::uint64_t& sum, double units) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  constexpr double kLargestRoot = 4294967295.0;
  const std::uint64_t square =
      units > kLargestRoot ? kMost : static_cast<std::uint64_t>(units) * static_cast<std::uint64_t>(units);
  sum = square > kMost - sum ? kMost : sum + square;
}

}  // namespace

std::vector<AncestorError> leafErrors(const RawGrid& grid, const GridGeometry& geometry, int level_count,
                                      std::int32_t x, std::int32_t y) {
  const PostRange columns = geometry.nodePosts(geometry.columnsAt(0), x);
  const PostRange rows = geometry.nodePosts(geometry.rowsAt(0), y);
  const std::vector<PostPlace> places = geometry.postPlaces(0, columns, rows);
  const std::int64_t leaf = geometry.header().leaf_cells;
  const std::int64_t owned_column_end =
      columns.end == geometry.columnsAt(0).end ? columns.end : (x + 1) * leaf;
  const std::int64_t owned_row_end = rows.end == geometry.rowsAt(0).end ? rows.end : (y + 1) * leaf;

  std::vector<AncestorError> errors(static_cast<std::size_t>(level_count - 1));
  for (int level = 1; level < level_count; ++level) {
    AncestorError& error = errors[static_cast<std::size_t>(level - 1)];
    const std::int64_t step = std::int64_t{1} << level;
    // One coarse cell more on each side, for posts whose facet is the next one.
    const CoarseWindow window(grid, geometry, level,
                              {floorDivide(columns.begin, step) - 1, floorDivide(columns.end - 1, step) + 3},
                              {floorDivide(rows.begin, step) - 1, floorDivide(rows.end - 1, step) + 3});
    double maximum = 0;
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
      for (std::int64_t column = columns.begin; column < columns.end; ++column) {
        if (!grid.isValid(column - grid.header.x_axis.first, row - grid.header.y_axis.first)) continue;
        double difference = 0;
        // A post of the coarse level is a corner of its facets: no difference.
        if (column % step != 0 || row % step != 0) {
          const PostPlace& place = places[static_cast<std::size_t>((row - rows.begin) * columns.size() +
                                                                   (column - columns.begin))];
          const Pierce surface = coarseSurfaceAt(window, column, row, step, place.foot, place.up);
          if (!surface.valid) continue;
          const double height =
              geometry.metres(grid.height(column - grid.header.x_axis.first, row - grid.header.y_axis.first));
          difference = std::abs(height - surface.height);
        }
        maximum = std::max(maximum, difference);
        if (column < owned_column_end && row < owned_row_end) {
          addSquare(error.sum_of_squares, std::round(difference / kErrorUnit));
          ++error.posts;
        }
      }
    }
    error.maximum = static_cast<std::uint32_t>(
        std::min(std::ceil(maximum / kErrorUnit), static_cast<double>(kUnknownError)));
  }
  return errors;
}

}  // namespace deltaz
