#include "libdb/access/grid_geometry.h"

#include <algorithm>
#include <utility>

#include "libdb/access/patch_surface.h"

namespace deltaz {

std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}
std::int64_t ceilDivide(std::int64_t a, std::int64_t b) {
  return -floorDivide(-a, b);
}

double postCoordinate(const GridAxis& axis, const AxisOrigin& origin, std::int64_t global) {
  if (axis.exact_spacing && axis.phase == 0) {
    // Whole fractions: the division is the only rounding, so that post 1200 of 3" is 1 degree exactly. The
    // origin is brought to the same denominator first.
    const std::int64_t numerator = axis.exact_spacing->numerator;
    const std::int64_t denominator = axis.exact_spacing->denominator;
    const double steps = static_cast<double>(global) * static_cast<double>(numerator) +
                         origin.coordinate * origin.exact_per_unit * static_cast<double>(denominator);
    return steps / (origin.exact_per_unit * static_cast<double>(denominator));
  }
  return origin.coordinate + (static_cast<double>(global) + axis.phase) * axis.spacing;
}

double postLongitude(const GridAxis& axis, std::int64_t global_column) {
  return postCoordinate(axis, kLongitudeOrigin, global_column);
}
double postLatitude(const GridAxis& axis, std::int64_t global_row) {
  // A source may place its outermost row beyond the pole by a rounding error.
  return std::clamp(postCoordinate(axis, kLatitudeOrigin, global_row), -90.0, 90.0);
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

GridGeometry::GridGeometry(const GridHeader& grid, std::shared_ptr<const PatchLattice> patches)
    : grid_(grid),
      quantum_(grid.quantum.value()),
      patches_(std::move(patches)),
      axes_(std::make_shared<const PostAxes>(grid)) {}

double GridGeometry::xCoordinate(std::int64_t global_column) const {
  return postCoordinate(grid_.x_axis, isGeodetic() ? kLongitudeOrigin : kProjectedOrigin, global_column);
}
double GridGeometry::yCoordinate(std::int64_t global_row) const {
  return isGeodetic() ? latitude(global_row) : postCoordinate(grid_.y_axis, kProjectedOrigin, global_row);
}

double GridGeometry::longitude(std::int64_t global_column) const {
  return postLongitude(grid_.x_axis, global_column);
}
double GridGeometry::latitude(std::int64_t global_row) const {
  return postLatitude(grid_.y_axis, global_row);
}

namespace {

// The normal of the ellipsoid at a point of its surface: the gradient of (x^2 + y^2) / a^2 + z^2 / b^2.
Vector3 normalAt(const EllipsoidShape& ellipsoid, const Vector3& foot) {
  const double f = ellipsoid.inverse_flattening == 0 ? 0 : 1 / ellipsoid.inverse_flattening;
  return normalized({foot.x, foot.y, foot.z / ((1 - f) * (1 - f))});
}

}  // namespace

PostPlace GridGeometry::placeAt(std::int64_t global_column, std::int64_t global_row) const {
  if (isGeodetic()) {
    const RowConstants row = rowConstants(grid_.ellipsoid, latitude(global_row));
    const ColumnConstants column = columnConstants(longitude(global_column));
    return {earthCentred(row, column, 0), upVector(row, column)};
  }
  const Vector3 foot = patchPosition(*patches_, global_column, global_row);
  return {foot, normalAt(grid_.ellipsoid, foot)};
}

GeodeticPoint GridGeometry::geodeticAt(std::int64_t global_column, std::int64_t global_row) const {
  if (isGeodetic()) return {latitude(global_row), longitude(global_column), 0};
  GeodeticPoint point = toGeodetic(grid_.ellipsoid, patchPosition(*patches_, global_column, global_row));
  point.height = 0;
  return point;
}

std::vector<PostPlace> GridGeometry::postPlaces(int level, PostRange columns, PostRange rows) const {
  std::vector<PostPlace> points;
  points.reserve(static_cast<std::size_t>(columns.size() * rows.size()));
  if (isGeodetic()) {
    const std::vector<ColumnConstants> of_columns = columnConstantsOf(level, columns);
    for (const RowConstants& row : rowConstantsOf(level, rows)) {
      for (const ColumnConstants& column : of_columns)
        points.push_back({earthCentred(row, column, 0), upVector(row, column)});
    }
    return points;
  }
  const std::int64_t step = std::int64_t{1} << level;
  for (const Vector3& foot :
       patchPositions(*patches_, columns.begin * step, columns.size(), rows.begin * step, rows.size(), step))
    points.push_back({foot, normalAt(grid_.ellipsoid, foot)});
  return points;
}

PostRange GridGeometry::columnsAt(int level) const {
  return rangeAt(grid_.x_axis, level);
}
PostRange GridGeometry::rowsAt(int level) const {
  return rangeAt(grid_.y_axis, level);
}
PostRange GridGeometry::nodeColumnsAt(int level) const {
  return nodeRangeAt(grid_.x_axis, grid_.leaf_cells, level);
}
PostRange GridGeometry::nodeRowsAt(int level) const {
  return nodeRangeAt(grid_.y_axis, grid_.leaf_cells, level);
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
