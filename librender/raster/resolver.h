// The resolver: depth/frame buffer -> picture. Every visible sample is shaded once; the sea is put in where
// it is nearer, the sky where there is nothing; haze over all of it, sRGB at the end.
//
// Runs on the threads of the caller's TBB arena.
#pragma once

#include <cstdint>
#include <vector>

#include "librender/raster/depth_frame_buffer.h"
#include "librender/raster/pretiler.h"
#include "librender/scene/environment.h"

namespace deltaz {

struct ResolverStatistics {
  std::uint64_t covered = 0;  // pixels on which some face was drawn
  std::uint64_t shaded = 0;   // of these, the ones where it is seen
};

ResolverStatistics resolve(const Environment& environment, const std::vector<PretiledNode>& nodes,
                           const DepthFrameBuffer& buffer, Picture& picture);

}  // namespace deltaz
