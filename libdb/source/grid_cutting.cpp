#include "libdb/source/grid_cutting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/source/full_turn.h"

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

double positionOf(const GridAxis& axis, const AxisOrigin& origin, double coordinate) {
  return (coordinate - postCoordinate(axis, origin, axis.first)) / axis.spacing;
}

// Of the columns between two longitudes, west <= east. The same meridian has many of them.
std::vector<Span> columnsBetween(const GridHeader& header, double west, double east) {
  const GridAxis& axis = header.x_axis;
  const auto at = [&axis](double longitude) { return positionOf(axis, kLongitudeOrigin, longitude); };
  const double most = static_cast<double>(axis.count - 1);
  constexpr std::array<double, 5> kTurns = {0.0, 360.0, -360.0, 720.0, -720.0};
  for (const double turn : kTurns) {
    const double low = at(west + turn), high = at(east + turn);
    if (low >= -kOnBounds && high <= most + kOnBounds) return {spanOf(low, high, axis.count)};
  }
  if (const std::int64_t turn = fullTurn(header); turn > 0) {
    auto first = static_cast<std::int64_t>(std::floor(at(west) + kOnBounds));
    const auto last = static_cast<std::int64_t>(std::ceil(at(east) - kOnBounds));
    const std::int64_t count = std::max<std::int64_t>(last - first + 1, 2);
    if (count > turn) return {{0, axis.count}};
    first -= turn * floorDivide(first, turn);
    return {{first, count}};
  }
  std::vector<Span> sides, touched;
  for (const double turn : kTurns) {
    const double low = at(west + turn), high = at(east + turn);
    const Span found = spanOf(low, high, axis.count);
    if (found.count == 0) continue;
    // Bounds that end on an outermost column take no more than that from there.
    const bool inside = std::min(high, most) - std::max(low, 0.0) > kOnBounds;
    (inside ? sides : touched).push_back(found);
  }
  if (sides.empty()) return touched;
  std::sort(sides.begin(), sides.end(), [](const Span& a, const Span& b) { return a.first < b.first; });
  std::vector<Span> apart;
  for (const Span& side : sides) {
    if (!apart.empty() && side.first <= apart.back().first + apart.back().count) {
      apart.back().count = std::max(apart.back().count, side.first + side.count - apart.back().first);
    } else {
      apart.push_back(side);
    }
  }
  return apart;
}

std::vector<PostWindow> windowsOf(const std::vector<Span>& columns, const Span& rows) {
  std::vector<PostWindow> windows;
  for (const Span& span : columns) {
    if (span.count > 0 && rows.count > 0) windows.push_back({span.first, span.count, rows.first, rows.count});
  }
  return windows;
}

// What the outline of the bounds encloses in coordinates of a grid.
struct Extent {
  double west = std::numeric_limits<double>::infinity(), east = -west, south = west, north = -west;
};

}  // namespace

Result<std::vector<PostWindow>> windowsWithin(const GridHeader& header, const ReferenceSystem& system,
                                              const ReferenceSystem& area, const SourceBounds& bounds,
                                              bool allow_ballpark, const std::string& path) {
  const bool geodetic = header.kind == "geodetic";
  const double east = bounds.east < bounds.west ? bounds.east + 360 : bounds.east;
  Extent extent{bounds.west, east, bounds.south, bounds.north};
  if (!geodetic || !sameDatum(system, area)) {
    std::vector<double> longitudes, x, y;
    const auto add = [&](double longitude, double latitude) {
      longitudes.push_back(longitude);
      y.push_back(latitude);
    };
    for (int k = 0; k <= kOutlinePoints; ++k) {
      const double share = static_cast<double>(k) / kOutlinePoints;
      const double longitude = bounds.west + share * (east - bounds.west);
      const double latitude = bounds.south + share * (bounds.north - bounds.south);
      for (const double side : {bounds.south, bounds.north}) add(longitude, side);
      for (const double side : {bounds.west, east}) add(side, latitude);
    }
    x = longitudes;
    DELTAZ_TRY_ASSIGN(const CoordinateChange change,
                      CoordinateChange::between(area, system, allow_ballpark, path));
    (void)change.apply(x, y);  // what has no counterpart is NaN and does not count
    extent = {};
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (std::isnan(x[k])) continue;
      // Another datum moves a longitude by seconds, not by a turn.
      if (geodetic) x[k] -= 360 * std::round((x[k] - longitudes[k]) / 360);
      extent.west = std::min(extent.west, x[k]);
      extent.east = std::max(extent.east, x[k]);
      extent.south = std::min(extent.south, y[k]);
      extent.north = std::max(extent.north, y[k]);
    }
    if (!(extent.west <= extent.east)) return std::vector<PostWindow>{};
  }
  const AxisOrigin of_y = geodetic ? kLatitudeOrigin : kProjectedOrigin;
  const Span rows = spanOf(positionOf(header.y_axis, of_y, extent.south),
                           positionOf(header.y_axis, of_y, extent.north), header.y_axis.count);
  if (geodetic) return windowsOf(columnsBetween(header, extent.west, extent.east), rows);
  return windowsOf({spanOf(positionOf(header.x_axis, kProjectedOrigin, extent.west),
                           positionOf(header.x_axis, kProjectedOrigin, extent.east), header.x_axis.count)},
                   rows);
}

void cutTo(RawGrid& grid, const PostWindow& window) {
  GridHeader& header = grid.header;
  const std::int64_t turn = columnsInTurn(header), columns = header.x_axis.count;
  if (window.columns == columns && window.rows == header.y_axis.count && window.first_column == 0) return;
  // Where the columns begin anew, past the last one, and where in the grid they do so.
  const std::int64_t end = window.first_column + window.columns;
  const std::int64_t before = std::min(end, columns) - window.first_column;
  const std::int64_t anew = columns - turn;
  const auto cut = [&](auto& posts, const auto& choose) {
    if (posts.empty()) return;
    std::remove_reference_t<decltype(posts)> kept;
    kept.reserve(static_cast<std::size_t>(window.columns * window.rows));
    for (std::int64_t row = window.first_row; row < window.first_row + window.rows; ++row) {
      const auto begin = posts.begin() + row * columns;
      kept.insert(kept.end(), begin + window.first_column, begin + window.first_column + before);
      if (end > columns) {
        // The meridian that is both first and last stands here once: with a height if either has one.
        if (anew == 1 && choose(row)) kept.back() = *begin;
        kept.insert(kept.end(), begin + anew, begin + anew + end - columns);
      }
    }
    posts = std::move(kept);
  };
  std::vector<bool> first_wins(static_cast<std::size_t>(header.y_axis.count), false);
  for (std::int64_t row = 0; row < header.y_axis.count && end > columns; ++row)
    first_wins[static_cast<std::size_t>(row)] = !grid.isValid(columns - 1, row) && grid.isValid(0, row);
  const auto choose = [&first_wins](std::int64_t row) { return first_wins[static_cast<std::size_t>(row)]; };
  cut(grid.heights, choose);
  cut(grid.valid, choose);
  cut(grid.void_kinds, choose);
  header.x_axis.first += window.first_column;
  // The west edge in [-180, 180).
  if (turn > 0) header.x_axis.first -= turn * floorDivide(header.x_axis.first, turn);
  header.x_axis.count = window.columns;
  header.y_axis.first += window.first_row;
  header.y_axis.count = window.rows;
}

}  // namespace deltaz
