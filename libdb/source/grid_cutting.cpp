#include "libdb/source/grid_cutting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

namespace {

// Points along each side of the bounds that are projected; between them a side bends less than a post.
constexpr int kOutlinePoints = 512;
// A post this far outside (in posts) is on the bounds: they were written as decimals.
constexpr double kOnBounds = 1e-6;

struct Span {
  std::int64_t first = 0, count = 0;
};

// Posts 0 .. count - 1 between the positions low and high (in posts), outwards to the next.
Span spanOf(double low, double high, std::int64_t count) {
  if (!(high >= -kOnBounds) || !(low <= static_cast<double>(count - 1) + kOnBounds)) return {};
  const double most = static_cast<double>(count - 1);
  auto first = static_cast<std::int64_t>(std::floor(std::clamp(low + kOnBounds, 0.0, most)));
  auto last = static_cast<std::int64_t>(std::ceil(std::clamp(high - kOnBounds, 0.0, most)));
  // One row of posts is no surface.
  if (last == first) (last < count - 1 ? last : first) += last < count - 1 ? 1 : -1;
  return {first, last - first + 1};
}

PostWindow windowOf(const Span& columns, const Span& rows) {
  if (columns.count == 0 || rows.count == 0) return {};
  return {columns.first, columns.count, rows.first, rows.count};
}

double positionOf(const GridAxis& axis, const AxisOrigin& origin, double coordinate) {
  return (coordinate - postCoordinate(axis, origin, axis.first)) / axis.spacing;
}

PostWindow geodeticWindow(const GridHeader& header, const SourceBounds& bounds) {
  const double east = bounds.east < bounds.west ? bounds.east + 360 : bounds.east;
  Span columns;
  // The same meridian has many longitudes; the turn with the most posts counts.
  for (const double turn : {0.0, 360.0, -360.0, 720.0, -720.0}) {
    const Span found = spanOf(positionOf(header.x_axis, kLongitudeOrigin, bounds.west + turn),
                              positionOf(header.x_axis, kLongitudeOrigin, east + turn), header.x_axis.count);
    if (found.count > columns.count) columns = found;
  }
  const Span rows = spanOf(positionOf(header.y_axis, kLatitudeOrigin, bounds.south),
                           positionOf(header.y_axis, kLatitudeOrigin, bounds.north), header.y_axis.count);
  return windowOf(columns, rows);
}

}  // namespace

Result<PostWindow> windowWithin(const GridHeader& header, const ReferenceSystem& system,
                                const ReferenceSystem& area, const SourceBounds& bounds, bool allow_ballpark,
                                const std::string& path) {
  if (header.kind == "geodetic" && sameDatum(system, area)) return geodeticWindow(header, bounds);
  const double east = bounds.east < bounds.west ? bounds.east + 360 : bounds.east;
  std::vector<double> x, y;
  for (int k = 0; k <= kOutlinePoints; ++k) {
    const double share = static_cast<double>(k) / kOutlinePoints;
    const double longitude = bounds.west + share * (east - bounds.west);
    const double latitude = bounds.south + share * (bounds.north - bounds.south);
    for (const double side : {bounds.south, bounds.north}) {
      x.push_back(longitude);
      y.push_back(side);
    }
    for (const double side : {bounds.west, east}) {
      x.push_back(side);
      y.push_back(latitude);
    }
  }
  DELTAZ_TRY_ASSIGN(const CoordinateChange change,
                    CoordinateChange::between(area, system, allow_ballpark, path));
  (void)change.apply(x, y);  // what has no counterpart is NaN and does not count
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double west = kInfinity, easternmost = -kInfinity, south = kInfinity, north = -kInfinity;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(x[k])) continue;
    west = std::min(west, x[k]);
    easternmost = std::max(easternmost, x[k]);
    south = std::min(south, y[k]);
    north = std::max(north, y[k]);
  }
  const bool geodetic = header.kind == "geodetic";
  const AxisOrigin of_x = geodetic ? kLongitudeOrigin : kProjectedOrigin;
  const AxisOrigin of_y = geodetic ? kLatitudeOrigin : kProjectedOrigin;
  return windowOf(spanOf(positionOf(header.x_axis, of_x, west), positionOf(header.x_axis, of_x, easternmost),
                         header.x_axis.count),
                  spanOf(positionOf(header.y_axis, of_y, south), positionOf(header.y_axis, of_y, north),
                         header.y_axis.count));
}

void cutTo(RawGrid& grid, const PostWindow& window) {
  GridHeader& header = grid.header;
  if (window.columns == header.x_axis.count && window.rows == header.y_axis.count) return;
  const auto cut = [&](auto& posts) {
    if (posts.empty()) return;
    std::remove_reference_t<decltype(posts)> kept;
    kept.reserve(static_cast<std::size_t>(window.columns * window.rows));
    for (std::int64_t row = window.first_row; row < window.first_row + window.rows; ++row) {
      const auto begin = posts.begin() + row * header.x_axis.count + window.first_column;
      kept.insert(kept.end(), begin, begin + window.columns);
    }
    posts = std::move(kept);
  };
  cut(grid.heights);
  cut(grid.valid);
  cut(grid.void_kinds);
  header.x_axis.first += window.first_column;
  header.x_axis.count = window.columns;
  header.y_axis.first += window.first_row;
  header.y_axis.count = window.rows;
}

}  // namespace deltaz
