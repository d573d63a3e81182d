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

// Whose pixels are seen (pixel_names.h).
struct StreamNames {
  std::vector<std::uint32_t> owner;  // by pixel; kOfBackground where nothing with a name is
  std::vector<std::uint32_t> tiled;  // names of triangles that have pixels; a name may stand there often
  std::uint64_t pixels = 0;          // of all triangles with names
};

// The same, and the names of what is seen: `names` has one for each triangle of each batch. In simulated time
// the machine's samples of the first pass are named as they are taken; without, they are sampled once more,
// because its vectors of whole lines have no room for names and are far quicker without.
Result<PlayedStream> playStream(const TriangleStream& stream, const ArsOptions& options,
                                const std::vector<std::vector<std::uint32_t>>& names, StreamNames& seen);

}  // namespace deltaz::ars
