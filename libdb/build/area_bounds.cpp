#include "libdb/build/area_bounds.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace deltaz {

namespace {

DegreeBounds outlineBounds(const GridGeometry& geometry) {
  const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
  std::vector<GeodeticPoint> outline;
  for (std::int64_t i = columns.begin; i < columns.end; ++i)
    outline.push_back(geometry.geodeticAt(i, rows.begin));
  for (std::int64_t j = rows.begin; j < rows.end; ++j)
    outline.push_back(geometry.geodeticAt(columns.end - 1, j));
  for (std::int64_t i = columns.end; i-- > columns.begin;)
    outline.push_back(geometry.geodeticAt(i, rows.end - 1));
  for (std::int64_t j = rows.end; j-- > rows.begin;) outline.push_back(geometry.geodeticAt(columns.begin, j));

  // Longitudes are followed along the outline, so that the antimeridian is no jump.
  double longitude = outline.front().longitude;
  DegreeBounds bounds{longitude, outline.front().latitude, longitude, outline.front().latitude};
  double latitudes = 0;
  for (const GeodeticPoint& point : outline) {
    longitude += std::remainder(point.longitude - longitude, 360.0);
    bounds.west = std::min(bounds.west, longitude);
    bounds.east = std::max(bounds.east, longitude);
    bounds.south = std::min(bounds.south, point.latitude);
    bounds.north = std::max(bounds.north, point.latitude);
    latitudes += point.latitude;
  }
  // The outline ends where it began, or a full turn further if a pole lies inside.
  if (std::abs(longitude - outline.front().longitude) > 180) {
    (latitudes > 0 ? bounds.north : bounds.south) = latitudes > 0 ? 90 : -90;
    bounds.west = -180;
    bounds.east = 180;
  }
  const double turns = std::floor((bounds.west + 180) / 360) * 360;
  bounds.west -= turns;
  bounds.east -= turns;
  return bounds;
}

}  // namespace

DegreeBounds boundsOf(const GridGeometry& geometry) {
  if (!geometry.isGeodetic()) return outlineBounds(geometry);
  const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
  return {geometry.longitude(columns.begin), geometry.latitude(rows.begin),
          geometry.longitude(columns.end - 1), geometry.latitude(rows.end - 1)};
}

DegreeBounds boundsOf(std::span<const GridGeometry* const> grids) {
  std::vector<DegreeBounds> each;
  for (const GridGeometry* grid : grids) each.push_back(boundsOf(*grid));
  if (each.size() == 1) return each.front();
  DegreeBounds best;
  double narrowest = 361;
  // The range begins at some grid's west; the shortest of these is taken.
  for (const DegreeBounds& start : each) {
    DegreeBounds all = start;
    for (const DegreeBounds& other : each) {
      double west = std::remainder(other.west - start.west, 360.0);
      if (west < 0) west += 360;
      all.east = std::max(all.east, start.west + west + (other.east - other.west));
      all.south = std::min(all.south, other.south);
      all.north = std::max(all.north, other.north);
    }
    if (all.east - all.west >= narrowest) continue;
    narrowest = all.east - all.west;
    best = all;
  }
  // Grids that leave no gap anywhere go all around.
  if (narrowest > 360) return {-180, best.south, 180, best.north};
  return best;
}

}  // namespace deltaz
