#include "libdb/source/grid_placement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

namespace {

// Sources name their spacing in seconds, or in a simple fraction of one (1/3", 1/9", 3/10"); larger
// denominators would fit anything.
constexpr std::int64_t kLargestDenominator = 1000;

// The simplest fraction within `tolerance` of `value` > 0 (continued fraction); nothing if its denominator
// would be too large.
std::optional<Rational> simplestFraction(double value, double tolerance) {
  std::int64_t previous_numerator = 1, numerator = static_cast<std::int64_t>(std::floor(value));
  std::int64_t previous_denominator = 0, denominator = 1;
  double rest = value - std::floor(value);
  while (std::abs(value - static_cast<double>(numerator) / static_cast<double>(denominator)) > tolerance ||
         numerator == 0) {
    if (rest < 1e-12) return std::nullopt;
    const double inverse = 1.0 / rest;
    const double whole = std::floor(inverse);
    if (whole > static_cast<double>(kLargestDenominator)) return std::nullopt;
    const auto term = static_cast<std::int64_t>(whole);
    rest = inverse - whole;
    const std::int64_t next_numerator = term * numerator + previous_numerator;
    const std::int64_t next_denominator = term * denominator + previous_denominator;
    if (next_denominator > kLargestDenominator) return std::nullopt;
    previous_numerator = numerator;
    previous_denominator = denominator;
    numerator = next_numerator;
    denominator = next_denominator;
  }
  return Rational{numerator, denominator};
}

double largestDeviation(const GridAxis& axis, const AxisOrigin& origin, double first, double spacing) {
  const double at_first = postCoordinate(axis, origin, axis.first) - first;
  const double at_last = postCoordinate(axis, origin, axis.first + axis.count - 1) -
                         (first + static_cast<double>(axis.count - 1) * spacing);
  return std::max(std::abs(at_first), std::abs(at_last));
}

}  // namespace

GridAxis placeAxis(double first, double spacing, std::int64_t count, const AxisOrigin& origin) {
  const double tolerance = placementTolerance(origin);
  GridAxis axis;
  axis.count = count;
  // Whole multiples of an exact spacing, if the source lies on them.
  if (const std::optional<Rational> exact = simplestFraction(
          spacing * origin.exact_per_unit, tolerance * origin.exact_per_unit / static_cast<double>(count))) {
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

}  // namespace deltaz
