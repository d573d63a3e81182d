// Places the posts of a source on a grid axis: global index, phase and, where the spacing is a fraction of an
// arc-second, that fraction exactly. Pure functions.
#pragma once

#include <cstdint>

#include "formats/area.h"

namespace deltaz {

// A post may move this far when its place is taken to be the exact one that the source rounded: 0.1 mm on the
// ground.
inline constexpr double kPlacementTolerance = 1e-9;  // degrees

// Axis of `count` >= 2 posts from `first_degrees` on, `spacing_degrees` > 0 apart; `origin` is -180 or -90.
// Guarantee: postDegrees() of post k differs from first_degrees + k * spacing_degrees by at most
// kPlacementTolerance.
GridAxis placeAxis(double first_degrees, double spacing_degrees, std::int64_t count, double origin);

}  // namespace deltaz
