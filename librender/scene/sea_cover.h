// Where in a rectangle of the picture the sea is met, and how near it can be: what a resolver asks once for
// many samples. Thread-safety: pure functions.
#pragma once

#include <cstdint>

#include "librender/scene/sea.h"

namespace deltaz {

enum class SeaCover : std::uint8_t { kNowhere, kPartly, kEverywhere };

// Of all rays through the rectangle from (first_j, first_i) to (last_j, last_i), pixels. Exact but that it
// may say partly where there is nothing or all: the sea is convex on the screen, so it is everywhere if it is
// at all corners, and nowhere if it neither meets a side nor lies inside.
SeaCover seaCover(const SeaTerms& sea, const ViewTransform& view, double first_j, double first_i,
                  double last_j, double last_i);

// A plane on the screen that the sea's 1/U exceeds nowhere it is met: the tangent at (j, i), since the sea's
// 1/U is concave. Pre: the ray through (j, i) meets the sea.
struct SeaBound {
  double j = 0, i = 0;
  double value = 0, per_j = 0, per_i = 0;
  double at(double at_j, double at_i) const { return value + per_j * (at_j - j) + per_i * (at_i - i); }
};
SeaBound seaBound(const SeaTerms& sea, const ViewTransform& view, double j, double i);

}  // namespace deltaz
