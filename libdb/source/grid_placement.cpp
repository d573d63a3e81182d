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

double largestDeviation(const GridAxis& axis, double origin, double first_degrees, double spacing_degrees) {
  const double at_first = postDegrees(axis, origin, axis.first) - first_degrees;
  const double at_last = postDegrees(axis, origin, axis.first + axis.count - 1) -
                         (first_degrees + static_cast<double>(axis.count - 1) * spacing_degrees);
  return std::max(std::abs(at_first), std::abs(at_last));
}

}  // namespace

GridAxis placeAxis(double first_degrees, double spacing_degrees, std::int64_t count, double origin) {
  GridAxis axis;
  axis.count = count;
  // Whole multiples of an exact spacing, if the source lies on them.
  const double tolerance_arcseconds = kPlacementTolerance * 3600.0 / static_cast<double>(count);
  if (const std::optional<Rational> exact =
          simplestFraction(spacing_degrees * 3600.0, tolerance_arcseconds)) {
    axis.exact_spacing = *exact;
    axis.spacing_degrees = exact->value() / 3600.0;
    axis.phase = 0;
    axis.first = std::llround((first_degrees - origin) / axis.spacing_degrees);
    if (largestDeviation(axis, origin, first_degrees, spacing_degrees) <= kPlacementTolerance) return axis;
    axis.exact_spacing.reset();
  }
  // Otherwise the source's own spacing, with the sub-post phase of its first post.
  axis.spacing_degrees = spacing_degrees;
  const double position = (first_degrees - origin) / spacing_degrees;
  axis.first = std::llround(position);
  axis.phase = 0;
  if (largestDeviation(axis, origin, first_degrees, spacing_degrees) <= kPlacementTolerance) return axis;
  axis.first = static_cast<std::int64_t>(std::floor(position));
  axis.phase = std::min(position - std::floor(position), std::nextafter(1.0, 0.0));
  return axis;
}

}  // namespace deltaz
