// How far a picture shows the ground from where it is: measured from the picture's own depth, whatever drew
// it.
//
// A pixel that shows terrain at depth U shows the point P = eye + U ray. Above or below P, along the
// ellipsoid normal, lies the full-resolution surface at Q; the displacement of the pixel is the distance on
// the screen between P and Q. It is what a tolerance in pixels promises (scheduler.h), at the places people
// see.
//
// Not measured are pixels with no full-resolution ground above or below P (beyond the edge of the area or of
// a void, where a coarser level draws what is not there), and those over faces that a seam replaced. Depth is
// a float, so a picture of the surface itself measures about 1e-4 pixel, more at grazing angles.
// Cost: each leaf under the picture is read and decoded once; some 100 bytes a pixel, a million pixels at a
// time. Errors: whatever reading the database reports. Thread-safety: pure function.
#pragma once

#include <cstdint>

#include "libdb/access/database.h"
#include "librender/scene/render.h"

namespace deltaz {

struct ShownDisplacement {
  double largest = 0;     // pixels; infinite where Q is behind the eye
  double nearly_all = 0;  // pixels: kNearlyAll of what was measured is within this
  double root_mean_square = 0;
  std::uint64_t measured = 0, unmeasured = 0;  // pixels that show terrain
};

inline constexpr double kNearlyAll = 0.999;

// `truth` may be another database than the one the picture was drawn from. `threads` as in RenderOptions.
Result<ShownDisplacement> measureShownDisplacement(const Database& truth, const Camera& camera,
                                                   const Picture& picture, int threads);

}  // namespace deltaz
