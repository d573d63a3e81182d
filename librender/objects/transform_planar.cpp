#include "librender/objects/transform_planar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace deltaz {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;

struct HeightRange {
  std::int32_t base = 0;
  std::int64_t reach = 0;
};

HeightRange heightRange(const TerrainTile& tile) {
  std::int64_t low = 0, high = 0;
  bool any = false;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) continue;
      const std::int64_t height = tile.height(i, j);
      low = any ? std::min(low, height) : height;
      high = any ? std::max(high, height) : height;
      any = true;
    }
  }
  const std::int64_t base = low + (high - low) / 2;
  return {static_cast<std::int32_t>(base), std::max(high - base, base - low)};
}

// The angles a geodetic tile covers, degrees.
struct Extent {
  double south = 0, north = 0, west = 0, east = 0;
};

Extent extentOf(const TerrainTile& tile, const GridGeometry& geometry) {
  const std::int64_t step = std::int64_t{1} << tile.level;
  return {geometry.latitude(tile.first_row * step),
          geometry.latitude((tile.first_row + tile.rows - 1) * step),
          geometry.longitude(tile.first_column * step),
          geometry.longitude((tile.first_column + tile.columns - 1) * step)};
}

void setGeodeticFrame(const TerrainTile& tile, const GridGeometry& geometry, PlanarGrid& planar) {
  const Extent extent = extentOf(tile, geometry);
  const EllipsoidShape& ellipsoid = geometry.header().ellipsoid;
  const RowConstants row = rowConstants(ellipsoid, (extent.south + extent.north) / 2);
  const ColumnConstants column = columnConstants((extent.west + extent.east) / 2);
  const double f = ellipsoid.inverse_flattening == 0 ? 0 : 1 / ellipsoid.inverse_flattening;
  const double e2 = f * (2 - f), square = 1 - e2 * row.s * row.s;
  const double meridian = ellipsoid.semi_major_axis * (1 - e2) / (square * std::sqrt(square));
  const double per_column = tile.columns > 1 ? (extent.east - extent.west) / (tile.columns - 1) * kRadian : 0;
  const double per_row = tile.rows > 1 ? (extent.north - extent.south) / (tile.rows - 1) * kRadian : 0;
  planar.origin = earthCentred(row, column, planar.base_height);
  planar.up = upVector(row, column);
  planar.east = Vector3{-column.sine, column.cosine, 0} * ((row.a + row.b * planar.base_height) * per_column);
  planar.north = Vector3{-row.s * column.cosine, -row.s * column.sine, row.b} *
                 ((meridian + planar.base_height) * per_row);
}

void setProjectedFrame(const TerrainTile& tile, const GridGeometry& geometry, PlanarGrid& planar) {
  const std::int64_t step = std::int64_t{1} << tile.level;
  // A post and not the point between posts: patches place posts only.
  planar.middle_column = (tile.columns - 1) / 2;
  planar.middle_row = (tile.rows - 1) / 2;
  const std::int64_t column = tile.first_column + (tile.columns - 1) / 2;
  const std::int64_t row = tile.first_row + (tile.rows - 1) / 2;
  const auto place = [&](std::int64_t i, std::int64_t j) { return geometry.placeAt(i * step, j * step); };
  const PostPlace middle = place(column, row);
  planar.origin = middle.at(planar.base_height);
  planar.up = middle.up;
  if (tile.columns > 1) {
    planar.east = (place(tile.first_column + tile.columns - 1, row).at(planar.base_height) -
                   place(tile.first_column, row).at(planar.base_height)) *
                  (1.0 / (tile.columns - 1));
  }
  if (tile.rows > 1) {
    planar.north = (place(column, tile.first_row + tile.rows - 1).at(planar.base_height) -
                    place(column, tile.first_row).at(planar.base_height)) *
                   (1.0 / (tile.rows - 1));
  }
}

double geodeticBound(const TerrainTile& tile, const GridGeometry& geometry, const PlanarGrid& planar) {
  const Extent extent = extentOf(tile, geometry);
  const EllipsoidShape& ellipsoid = geometry.header().ellipsoid;
  const double f = ellipsoid.inverse_flattening == 0 ? 0 : 1 / ellipsoid.inverse_flattening;
  const double e2 = f * (2 - f);
  const double p = (extent.north - extent.south) / 2 * kRadian;
  const double l = (extent.east - extent.west) / 2 * kRadian;
  const double quantum = geometry.header().quantum.value();
  const double k = static_cast<double>(planar.height_reach) * quantum;
  const double height = std::abs(planar.base_height) + k;
  const double south = extent.south * kRadian, north = extent.north * kRadian;
  const double sine = std::max(std::abs(std::sin(south)), std::abs(std::sin(north)));
  const double cosine = south <= 0 && north >= 0 ? 1.0 : std::max(std::cos(south), std::cos(north));
  // Radii at their largest: both at the poles, a / (1 - e2)^(1/2), or, where the poles are the farther ends
  // (e2 < 0), M at the equator, a (1 - e2). And |dM/dlat| = 3 |e2| M |sin cos| / (1 - e2 sin^2).
  const double radius = ellipsoid.semi_major_axis * std::max(1 / std::sqrt(1 - e2), 1 - e2);
  const double change = 3 * std::abs(e2) * radius * sine * cosine / std::min(1.0, 1 - e2);
  const double second = (radius + height + change) * p * p + 2 * (radius + height) * sine * p * l +
                        (radius + height) * cosine * l * l;
  return second / 2 + p * k + cosine * l * k;
}

double projectedBound(const TerrainTile& tile, const GridGeometry& geometry, const PlanarGrid& planar) {
  const std::vector<PostPlace> places =
      geometry.postPlaces(tile.level, {tile.first_column, tile.first_column + tile.columns},
                          {tile.first_row, tile.first_row + tile.rows});
  double largest = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) continue;
      const double height = geometry.metres(tile.height(i, j));
      const Vector3 flat = planar.origin + planar.east * (i - planar.middle_column) +
                           planar.north * (j - planar.middle_row) + planar.up * (height - planar.base_height);
      const std::size_t post =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns) + static_cast<std::size_t>(i);
      largest = std::max(largest, length(places[post].at(height) - flat));
    }
  }
  return largest;
}

}  // namespace

PlanarGrid planarGridOf(const TerrainTile& tile, const GridGeometry& geometry) {
  PlanarGrid planar;
  const HeightRange heights = heightRange(tile);
  planar.base = heights.base;
  planar.base_height = geometry.metres(heights.base);
  planar.height_reach = heights.reach;
  planar.middle_column = (tile.columns - 1) / 2.0;
  planar.middle_row = (tile.rows - 1) / 2.0;
  if (geometry.isGeodetic()) {
    setGeodeticFrame(tile, geometry, planar);
  } else {
    setProjectedFrame(tile, geometry, planar);
  }
  return planar;
}

double planarityBound(const TerrainTile& tile, const GridGeometry& geometry) {
  if (tile.columns < 1 || tile.rows < 1) return 0;
  const PlanarGrid planar = planarGridOf(tile, geometry);
  return geometry.isGeodetic() ? geodeticBound(tile, geometry, planar)
                               : projectedBound(tile, geometry, planar);
}

}  // namespace deltaz
