#include "libdb/access/ground_query.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libdb/access/grid_locator.h"

namespace deltaz {

namespace {

// Where a coordinate falls on an axis: the post at or before it and the fraction of a cell beyond that post.
struct CellPosition {
  std::int64_t post = 0;
  double fraction = 0;
};

std::optional<CellPosition> locate(const GridAxis& axis, const AxisOrigin& origin, double degrees) {
  const double steps = (degrees - origin.coordinate) / axis.spacing - axis.phase;
  // A position written with fifteen digits may miss the outermost post by a rounding error.
  constexpr double kRoundingPosts = 1e-6;
  const double first = static_cast<double>(axis.first),
               last = static_cast<double>(axis.first + axis.count - 1);
  if (!(steps >= first - kRoundingPosts && steps <= last + kRoundingPosts)) return std::nullopt;
  CellPosition position;
  position.post =
      std::clamp(static_cast<std::int64_t>(std::floor(steps)), axis.first, axis.first + axis.count - 2);
  position.fraction = std::clamp(steps - static_cast<double>(position.post), 0.0, 1.0);
  return position;
}

// The leaf that holds a cell, found from the grid's cluster node down; nothing where the tree ends before.
Result<std::optional<Node>> leafAt(const Database& database, const Node& cluster, std::int64_t x,
                                   std::int64_t y) {
  Node node = cluster;
  while (node.record.type == NodeType::kCluster || node.record.level > 0) {
    DELTAZ_TRY_ASSIGN(const std::vector<Node> children, database.children(node));
    const auto holds = [x, y](const Node& child) {
      return child.record.type == NodeType::kTerrain && child.record.x == x >> child.record.level &&
             child.record.y == y >> child.record.level;
    };
    const auto child = std::find_if(children.begin(), children.end(), holds);
    if (child == children.end()) return std::optional<Node>{};
    node = *child;
  }
  return std::optional<Node>{node};
}

// Height at which the ellipsoid normal over (row, column) meets the plane through three points.
double heightOnFacet(const Vector3& a, const Vector3& b, const Vector3& c, const RowConstants& row,
                     const ColumnConstants& column, double linear_height) {
  const Vector3 normal = cross(b - a, c - a);
  const double slope = dot(normal, upVector(row, column));
  // A facet at a pole, where a row is one point, has no plane.
  if (std::abs(slope) <= 1e-12 * length(normal) || length(normal) == 0) return linear_height;
  return dot(normal, a - earthCentred(row, column, 0)) / slope;
}

std::optional<double> heightInTile(const TerrainTile& tile, const GridGeometry& geometry, CellPosition x,
                                   CellPosition y, double latitude, double longitude) {
  const int i = static_cast<int>(x.post - tile.first_column), j = static_cast<int>(y.post - tile.first_row);
  if (i < 0 || j < 0 || i + 1 >= tile.columns || j + 1 >= tile.rows) return std::nullopt;
  const bool bottom = x.fraction >= y.fraction;
  if (!(bottom ? tile.bottomFaceValid(i, j) : tile.topFaceValid(i, j))) return std::nullopt;
  const auto metres = [&](int di, int dj) { return geometry.metres(tile.height(i + di, j + dj)); };
  const auto corner = [&](int di, int dj) {
    return earthCentred(rowConstants(geometry.header().ellipsoid, geometry.latitude(y.post + dj)),
                        columnConstants(geometry.longitude(x.post + di)), metres(di, dj));
  };
  const double linear = bottom ? metres(0, 0) + x.fraction * (metres(1, 0) - metres(0, 0)) +
                                     y.fraction * (metres(1, 1) - metres(1, 0))
                               : metres(0, 0) + y.fraction * (metres(0, 1) - metres(0, 0)) +
                                     x.fraction * (metres(1, 1) - metres(0, 1));
  return heightOnFacet(
      corner(0, 0), bottom ? corner(1, 0) : corner(1, 1), bottom ? corner(1, 1) : corner(0, 1),
      rowConstants(geometry.header().ellipsoid, latitude), columnConstants(longitude), linear);
}

// The same on a projected grid, whose cells are found by going back from Earth-centred positions.

// Where the line foot + t * up meets the triangle a, b, c; `outside` becomes how far it passes, in
// barycentric terms, 0 if it does not.
double heightOnTriangle(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& foot,
                        const Vector3& up, double& outside) {
  const Vector3 normal = cross(b - a, c - a);
  const double slope = dot(normal, up);
  const double t = dot(normal, a - foot) / slope;
  const Vector3 hit = foot + up * t;
  const double area = dot(normal, normal);
  const double least = std::min({dot(normal, cross(b - hit, c - hit)), dot(normal, cross(c - hit, a - hit)),
                                 dot(normal, cross(a - hit, b - hit))});
  outside = area > 0 && slope > 0 ? std::max(0.0, -least / area) : 2.0;
  return t;
}

Result<std::optional<double>> projectedHeight(const Database& database, const Node& cluster, double latitude,
                                              double longitude) {
  const GridGeometry& geometry = database.grid(cluster.record.grid);
  const GridHeader& grid = geometry.header();
  const RowConstants row = rowConstants(grid.ellipsoid, latitude);
  const ColumnConstants column = columnConstants(longitude);
  const Vector3 foot = earthCentred(row, column, 0), up = upVector(row, column);
  // A facet over the place lies in the grid's sphere, and as far above or below the place as its height is.
  const double highest = std::max(std::abs(geometry.metres(cluster.record.minimum_height)),
                                  std::abs(geometry.metres(cluster.record.maximum_height)));
  if (length(foot - cluster.centroid) > cluster.radius() + highest + 1) return std::optional<double>{};
  const std::optional<GridPlace> cell = GridLocator(geometry).locate(foot);
  if (!cell) return std::optional<double>{};
  // The cell that was found and those around it: the edges of facets bow, and the nearest hit wins.
  std::optional<double> best;
  constexpr double kOutside = 1e-6;  // of a facet, in barycentric terms
  double best_outside = kOutside;
  std::optional<TerrainTile> tile;
  for (std::int64_t j = cell->row - 1; j <= cell->row + 1; ++j) {
    for (std::int64_t i = cell->column - 1; i <= cell->column + 1; ++i) {
      const std::int64_t x = floorDivide(i, grid.leaf_cells), y = floorDivide(j, grid.leaf_cells);
      if (!tile || tile->x != x || tile->y != y) {
        DELTAZ_TRY_ASSIGN(const std::optional<Node> leaf, leafAt(database, cluster, x, y));
        if (!leaf || leaf->record.isEmpty()) continue;
        DELTAZ_TRY_ASSIGN(tile, database.terrain(*leaf));
      }
      const int ti = static_cast<int>(i - tile->first_column), tj = static_cast<int>(j - tile->first_row);
      if (ti < 0 || tj < 0 || ti + 1 >= tile->columns || tj + 1 >= tile->rows) continue;
      const auto corner = [&](int di, int dj) {
        return geometry.placeAt(i + di, j + dj).at(geometry.metres(tile->height(ti + di, tj + dj)));
      };
      const auto consider = [&](const Vector3& third, bool top) {
        double outside = 0;
        const Vector3 a = corner(0, 0), c = corner(1, 1);
        const double height = top ? heightOnTriangle(a, c, third, foot, up, outside)
                                  : heightOnTriangle(a, third, c, foot, up, outside);
        if (outside > best_outside || (best && outside == best_outside)) return;
        best = height;
        best_outside = outside;
      };
      if (tile->bottomFaceValid(ti, tj)) consider(corner(1, 0), false);
      if (tile->topFaceValid(ti, tj)) consider(corner(0, 1), true);
    }
  }
  return best;
}

}  // namespace

Result<std::optional<double>> groundHeight(const Database& database, double latitude, double longitude) {
  DELTAZ_TRY_ASSIGN(const Node root, database.root());
  DELTAZ_TRY_ASSIGN(const std::vector<Node> clusters, database.children(root));
  for (const Node& cluster : clusters) {
    const GridGeometry& geometry = database.grid(cluster.record.grid);
    const GridHeader& grid = geometry.header();
    if (!geometry.isGeodetic()) {
      DELTAZ_TRY_ASSIGN(const std::optional<double> height,
                        projectedHeight(database, cluster, latitude, longitude));
      if (height) return height;
      continue;
    }
    const auto y = locate(grid.y_axis, kLatitudeOrigin, latitude);
    if (!y) continue;
    for (const double turn : {0.0, 360.0, -360.0}) {
      const auto x = locate(grid.x_axis, kLongitudeOrigin, longitude + turn);
      if (!x) continue;
      DELTAZ_TRY_ASSIGN(const std::optional<Node> leaf,
                        leafAt(database, cluster, floorDivide(x->post, grid.leaf_cells),
                               floorDivide(y->post, grid.leaf_cells)));
      if (!leaf || leaf->record.isEmpty()) continue;
      DELTAZ_TRY_ASSIGN(const TerrainTile tile, database.terrain(*leaf));
      if (const auto height = heightInTile(tile, geometry, *x, *y, latitude, longitude)) return height;
    }
  }
  return std::optional<double>{};
}

}  // namespace deltaz
