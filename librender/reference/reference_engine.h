// The judge: double precision, every full-resolution triangle of the database and of every placed model,
// nothing skipped but back faces, and short enough to be believed by reading.
//
// Positions are GeographicLib's. A pixel is covered if the ray through its centre p = (1, j - centre_j, i -
// centre_i) has the same sign of p . (Vi x Vj) for all three edges: exact homogeneous edge functions, with no
// snapping, and no clipping but U > kHither. Depth is U of the face's plane, in double. The scene definitions
// (illumination, colour, haze, sea, sky) are those of librender/scene, as for every engine.
//
// With several samples a pixel every sample is drawn so and shaded by itself, and the colours are weighted in
// double.
//
// Tolerance and level options are ignored. Cost: seconds for millions of triangles; about 200 bytes a post,
// and 150 a sample.
#pragma once

#include "librender/scene/render.h"

namespace deltaz {

class ReferenceEngine : public Engine {
 public:
  Result<Picture> render(const Database& database, const RenderOptions& options,
                         FrameStatistics& statistics) const override;
};

}  // namespace deltaz
