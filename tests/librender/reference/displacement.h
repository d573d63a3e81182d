// Measures what a level of detail costs in accuracy: how far, on the screen, the drawn surface is from the
// full-resolution one. Independent of the scheduler's bound: it looks at every post.
#pragma once

#include "libdb/access/database.h"
#include "librender/scene/camera.h"

namespace deltaz {

struct Displacement {
  double largest_pixels = 0;
  double largest_metres = 0;  // along the ellipsoid normal, over the same posts
  double mean_square_pixels = 0;
  std::uint64_t posts = 0;  // full-resolution posts looked at, once for each face that covers them
};

// Over all full-resolution posts P in the picture that a valid face of level `level` covers: the distance on
// the screen between P and the point of that face pierced by the ellipsoid normal through P. Hidden and
// back-facing surface counts too. Cost: reads every node of both levels. Errors: those of reading.
Result<Displacement> measureDisplacement(const Database& database, const Camera& camera, int level);

}  // namespace deltaz
