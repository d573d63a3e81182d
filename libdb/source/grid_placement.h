// Places the posts of a source on a grid axis: global index, phase and, where the spacing is a fraction of an
// arc-second, that fraction exactly. Pure functions.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/area.h"

namespace deltaz {

// A post may move this far when its place is taken to be the exact one that the source rounded: 0.1 mm on the
// ground.
inline constexpr double kPlacementTolerance = 1e-9;           // degrees
inline constexpr double kProjectedPlacementTolerance = 1e-4;  // units of the projection

// The tolerance that goes with an origin.
inline double placementTolerance(const AxisOrigin& origin) {
  return origin.exact_per_unit == kProjectedOrigin.exact_per_unit ? kProjectedPlacementTolerance
                                                                  : kPlacementTolerance;
}

// Axis of `count` >= 2 posts from coordinate `first` on, `spacing` > 0 apart. Guarantee: postCoordinate() of
// post k differs from first + k * spacing by at most placementTolerance(origin).
GridAxis placeAxis(double first, double spacing, std::int64_t count, const AxisOrigin& origin);
// The same with another tolerance, for coordinates whose unit is not the origin's usual one.
GridAxis placeAxis(double first, double spacing, std::int64_t count, const AxisOrigin& origin,
                   double tolerance);

// The index on `axis` of the first post of `other`, if all posts of `other` are posts of `axis` (continued as
// far as needed) within `tolerance`.
std::optional<std::int64_t> indexOnAxis(const GridAxis& axis, const GridAxis& other, const AxisOrigin& origin,
                                        double tolerance);

}  // namespace deltaz
