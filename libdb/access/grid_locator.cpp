#include "libdb/access/grid_locator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace deltaz {

namespace {

// A fractional index, in two parts so that large indices keep their fraction's bits.
struct Index {
  std::int64_t whole = 0;
  double fraction = 0;
};

Index indexOf(double value) {
  const double nearest = std::round(value);
  if (std::abs(value - nearest) <= GridLocator::kSnap) return {static_cast<std::int64_t>(nearest), 0};
  const double whole = std::floor(value);
  return {static_cast<std::int64_t>(whole), value - whole};
}

}  // namespace

GridPlace GridLocator::snapped(double u, double v) {
  const Index x = indexOf(u), y = indexOf(v);
  GridPlace place{x.whole, y.whole, x.fraction, y.fraction};
  if (place.x != 0 && place.y != 0 && std::abs(place.x - place.y) <= kSnap) place.y = place.x;
  return place;
}

std::optional<GridPlace> GridLocator::locatePost(const GridGeometry& from, std::int64_t column,
                                                 std::int64_t row) const {
  if (geometry_.isGeodetic() && from.isGeodetic())
    return locateDegrees(from.latitude(row), from.longitude(column));
  return locate(from.placeAt(column, row).foot);
}

std::optional<GridPlace> GridLocator::locate(const Vector3& foot) const {
  if (!geometry_.isGeodetic()) return locateProjected(foot);
  const GeodeticPoint point = toGeodetic(geometry_.header().ellipsoid, foot);
  return locateDegrees(point.latitude, point.longitude);
}

std::optional<GridPlace> GridLocator::locateDegrees(double latitude, double longitude) const {
  const GridAxis &x = geometry_.header().x_axis, &y = geometry_.header().y_axis;
  const auto steps = [](const GridAxis& axis, const AxisOrigin& origin, double degrees) {
    const double units = axis.exact_spacing ? (degrees - origin.coordinate) * origin.exact_per_unit *
                                                  static_cast<double>(axis.exact_spacing->denominator) /
                                                  static_cast<double>(axis.exact_spacing->numerator)
                                            : (degrees - origin.coordinate) / axis.spacing;
    return units - axis.phase;
  };
  // The turn of the Earth that brings the place nearest to the grid's middle.
  const double turn = 360.0 / x.spacing,
               middle = static_cast<double>(x.first) + static_cast<double>(x.count) / 2;
  double u = steps(x, kLongitudeOrigin, longitude);
  u += std::round((middle - u) / turn) * turn;
  return snapped(u, steps(y, kLatitudeOrigin, latitude));
}

// Newton's method on posts, then the place inside the cell from its corners: bilinear, which departs from the
// patches by the bow of a single cell.
std::optional<GridPlace> GridLocator::locateProjected(const Vector3& foot) const {
  const PostRange columns = geometry_.columnsAt(0), rows = geometry_.rowsAt(0);
  const auto within = [](double index, PostRange range) {
    const double margin = static_cast<double>(range.size()) / 10 + 2;
    return std::clamp(index, static_cast<double>(range.begin) - margin,
                      static_cast<double>(range.end) + margin);
  };
  double u = static_cast<double>(columns.begin + columns.end) / 2,
         v = static_cast<double>(rows.begin + rows.end) / 2;
  constexpr int kMostSteps = 30;
  for (int step = 0; step < kMostSteps; ++step) {
    const double i = std::floor(u), j = std::floor(v), x = u - i, y = v - j;
    const auto corner = [&](int di, int dj) {
      return geometry_.placeAt(static_cast<std::int64_t>(i) + di, static_cast<std::int64_t>(j) + dj).foot;
    };
    const Vector3 sw = corner(0, 0), se = corner(1, 0), nw = corner(0, 1), ne = corner(1, 1);
    const Vector3 here = (sw * (1 - x) + se * x) * (1 - y) + (nw * (1 - x) + ne * x) * y;
    const Vector3 east = (se - sw) * (1 - y) + (ne - nw) * y, north = (nw - sw) * (1 - x) + (ne - se) * x;
    const Vector3 offset = foot - here;
    const double ee = dot(east, east), en = dot(east, north), nn = dot(north, north);
    const double oe = dot(offset, east), on = dot(offset, north), determinant = ee * nn - en * en;
    if (!(determinant > 0)) return std::nullopt;
    const double next_u = within(u + (oe * nn - on * en) / determinant, columns);
    const double next_v = within(v + (on * ee - oe * en) / determinant, rows);
    const bool settled = std::abs(next_u - u) < 1e-9 && std::abs(next_v - v) < 1e-9;
    u = next_u;
    v = next_v;
    if (settled) return snapped(u, v);
  }
  return std::nullopt;
}

}  // namespace deltaz
