// Which triangles of a view reach into which sub-image of its picture, so that no sub-image's pretiler looks
// at what another shows.
//
// A triangle is left out of a sub-image only where the pretiler would find it wholly beside, wholly before
// the hither plane or not finite; it is counted as that. Thread-safety: pure function. Cost: three
// projections a triangle; nothing for a picture of one sub-image.
#pragma once

#include <cstdint>
#include <vector>

#include "librender/ars/pretiler/pretiler.h"
#include "librender/ars/pretiler/screen_triangle.h"
#include "librender/scene/camera.h"

namespace deltaz::ars {

struct SubImageBins {
  std::vector<std::vector<std::uint32_t>> triangles;  // by sub-image: numbers, ascending
  PretilerCounts left_out;                            // what pretilers would have counted of the others
};

SubImageBins binTriangles(const std::vector<ViewTriangle>& triangles, const ViewTransform& view);

}  // namespace deltaz::ars
