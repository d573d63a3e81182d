#include "libdb/access/grid_geometry.h"

#include <algorithm>

namespace deltaz {

std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}
std::int64_t ceilDivide(std::int64_t a, std::int64_t b) {
  return -floorDivide(-a, b);
}

double postDegrees(const GridAxis& axis, double origin, std::int64_t global) {
  if (axis.exact_spacing && axis.phase == 0) {
    // Whole arc-second fractions: the division is the only rounding, so that post 1200 of 3" is 1 degree
    // exactly. The origin is brought to the same denominator first.
    const std::int64_t numerator = axis.exact_spacing->numerator;
    const std::int64_t denominator = axis.exact_spacing->denominator;
    const double steps = static_cast<double>(global) * static_cast<double>(numerator) +
                         origin * 3600.0 * static_cast<double>(denominator);
    return steps / (3600.0 * static_cast<double>(denominator));
  }
  return origin + (static_cast<double>(global) + axis.phase) * axis.spacing_degrees;
}

namespace {

PostRange rangeAt(const GridAxis& axis, int level) {
  const std::int64_t step = std::int64_t{1} << level;
  return {ceilDivide(axis.first, step), floorDivide(axis.first + axis.count - 1, step) + 1};
}

// Nodes whose cells overlap the area's cells.
PostRange nodeRangeAt(const GridAxis& axis, int leaf_cells, int level) {
  const std::int64_t span = static_cast<std::int64_t>(leaf_cells) << level;
  return {floorDivide(axis.first, span), floorDivide(axis.first + axis.count - 2, span) + 1};
}

}  // namespace

GridGeometry::GridGeometry(const GridHeader& grid) : grid_(grid), quantum_(grid.quantum.value()) {}

double GridGeometry::longitude(std::int64_t global_column) const {
  return postDegrees(grid_.longitude, -180.0, global_column);
}
double GridGeometry::latitude(std::int64_t global_row) const {
  // A source may place its outermost row beyond the pole by a rounding error.
  return std::clamp(postDegrees(grid_.latitude, -90.0, global_row), -90.0, 90.0);
}

PostRange GridGeometry::columnsAt(int level) const {
  return rangeAt(grid_.longitude, level);
}
PostRange GridGeometry::rowsAt(int level) const {
  return rangeAt(grid_.latitude, level);
}
PostRange GridGeometry::nodeColumnsAt(int level) const {
  return nodeRangeAt(grid_.longitude, grid_.leaf_cells, level);
}
PostRange GridGeometry::nodeRowsAt(int level) const {
  return nodeRangeAt(grid_.latitude, grid_.leaf_cells, level);
}

PostRange GridGeometry::nodePosts(PostRange level_posts, std::int32_t node_index) const {
  const std::int64_t first = static_cast<std::int64_t>(node_index) * grid_.leaf_cells;
  return {std::max(level_posts.begin, first), std::min(level_posts.end, first + grid_.leaf_cells + 1)};
}

std::vector<RowConstants> GridGeometry::rowConstantsOf(int level, PostRange range) const {
  std::vector<RowConstants> rows;
  rows.reserve(static_cast<std::size_t>(range.size()));
  for (std::int64_t g = range.begin; g < range.end; ++g) {
    rows.push_back(rowConstants(grid_.ellipsoid, latitude(g * (std::int64_t{1} << level))));
  }
  return rows;
}

std::vector<ColumnConstants> GridGeometry::columnConstantsOf(int level, PostRange range) const {
  std::vector<ColumnConstants> columns;
  columns.reserve(static_cast<std::size_t>(range.size()));
  for (std::int64_t g = range.begin; g < range.end; ++g)
    columns.push_back(columnConstants(longitude(g * (std::int64_t{1} << level))));
  return columns;
}

}  // namespace deltaz
