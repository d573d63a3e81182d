// The tiler: triangles -> samples -> depth/frame buffer. The picture is cut into square tiles; every tile
// takes the triangles that touch it in the order of submission, so the result is the same for any number of
// threads.
//
// Runs on the threads of the caller's TBB arena. Thread-safety: one call per buffer at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "librender/raster/depth_frame_buffer.h"
#include "librender/raster/pretiler.h"

namespace deltaz {

inline constexpr int kTileSide = 64;  // pixels

struct TilerStatistics {
  std::uint64_t tested = 0, written = 0;         // samples
  std::uint64_t faces_drawn = 0, no_sample = 0;  // faces that covered a sample, and that did not after all
};

TilerStatistics tile(const std::vector<PretiledNode>& nodes, DepthFrameBuffer& buffer);

}  // namespace deltaz
