#include "libdb/source/grid_placement.h"

#include <algorithm>
#include <cmath>

#include "libdb/access/grid_geometry.h"
#include "libdb/source/simple_fraction.h"

namespace deltaz {

namespace {

// Sources name their spacing in seconds, or in a simple fraction of one (1/3", 1/9", 3/10"); larger
// denominators would fit anything.
constexpr std::int64_t kLargestDenominator = 1000;

double largestDeviation(const GridAxis& axis, const AxisOrigin& origin, double first, double spacing) {
  const double at_first = postCoordinate(axis, origin, axis.first) - first;
  const double at_last = postCoordinate(axis, origin, axis.first + axis.count - 1) -
                         (first + static_cast<double>(axis.count - 1) * spacing);
  return std::max(std::abs(at_first), std::abs(at_last));
}

}  // namespace

GridAxis placeAxis(double first, double spacing, std::int64_t count, const AxisOrigin& origin) {
  return placeAxis(first, spacing, count, origin, placementTolerance(origin));
}

GridAxis placeAxis(double first, double spacing, std::int64_t count, const AxisOrigin& origin,
                   double tolerance) {
  GridAxis axis;
  axis.count = count;
  // Whole multiples of an exact spacing, if the source lies on them.
  if (const std::optional<Rational> exact = simplestFraction(
          spacing * origin.exact_per_unit, tolerance * origin.exact_per_unit / static_cast<double>(count),
          kLargestDenominator)) {
    axis.exact_spacing = *exact;
    axis.spacing = exact->value() / origin.exact_per_unit;
    axis.phase = 0;
    axis.first = std::llround((first - origin.coordinate) / axis.spacing);
    if (largestDeviation(axis, origin, first, spacing) <= tolerance) return axis;
    axis.exact_spacing.reset();
  }
  // Otherwise the source's own spacing, with the sub-post phase of its first post.
  axis.spacing = spacing;
  const double position = (first - origin.coordinate) / spacing;
  axis.first = std::llround(position);
  axis.phase = 0;
  if (largestDeviation(axis, origin, first, spacing) <= tolerance) return axis;
  axis.first = static_cast<std::int64_t>(std::floor(position));
  axis.phase = std::min(position - std::floor(position), std::nextafter(1.0, 0.0));
  return axis;
}

std::optional<std::int64_t> indexOnAxis(const GridAxis& axis, const GridAxis& other, const AxisOrigin& origin,
                                        double tolerance) {
  const double first = postCoordinate(other, origin, other.first);
  const double last = postCoordinate(other, origin, other.first + other.count - 1);
  const double position = (first - postCoordinate(axis, origin, 0)) / axis.spacing;
  if (!(std::abs(position) < 1e15)) return std::nullopt;
  const std::int64_t index = std::llround(position);
  if (std::abs(postCoordinate(axis, origin, index) - first) > tolerance ||
      std::abs(postCoordinate(axis, origin, index + other.count - 1) - last) > tolerance)
    return std::nullopt;
  return index;
}

}  // namespace deltaz
