// Plays a recorded stream on a machine: every sub-image in every colour, put together to one picture.
//
// Sub-images and passes run side by side on the threads of the caller's TBB arena; what comes out does not
// depend on their number. Errors: kUsage for machines that cannot be and for numbers that the stream lacks
// sources for. Thread-safety: pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "librender/ars/engine/ars_frame.h"
#include "librender/ars/engine/ars_options.h"
#include "librender/ars/words/triangle_stream.h"

namespace deltaz::ars {

// One word of a depth/frame memory.
struct DepthWord {
  std::uint32_t depth = 0;
  bool written = false;  // by anything but background
};

struct PlayedStream {
  int width = 0, height = 0;
  std::vector<std::vector<std::uint8_t>> color;  // of each pass, lines from the top
  std::vector<DepthWord> depth;
  std::vector<FrameRun> runs;            // by sub-image, then pass
  Picoseconds drawing = 0, reading = 0;  // of all runs one after the other; 0 untimed
};

// The options' numbers, with the stream's bias of depths.
TilerConfiguration tilerOf(const TriangleStream& stream, const ArsOptions& options);

Result<PlayedStream> playStream(const TriangleStream& stream, const ArsOptions& options);

}  // namespace deltaz::ars
