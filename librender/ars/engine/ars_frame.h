// What the machine did for one frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "librender/ars/machine/pass_statistics.h"
#include "librender/ars/pretiler/pretiler.h"

namespace deltaz::ars {

// One sub-image in one colour: what the machine does at a time.
struct FrameRun {
  std::uint32_t sub_image = 0;
  int pass = 0;
  std::uint64_t triangles = 0;  // sent, background included
  MemoryCounts memory;
  PassStatistics statistics;  // of a timed run; else empty
};

struct Frame {
  int picture_width = 0, picture_height = 0;  // samples
  int sub_images = 0, passes = 0;
  bool timed = false;
  std::string settings;          // all of them, as parseArsOptions reads them
  PretilerCounts pretiler;       // of all sub-images
  std::uint64_t background = 0;  // triangles of it, a pass
  std::vector<FrameRun> runs;    // by sub-image, then pass
  // Of all runs one after the other, as the one machine there was would have drawn them; 0 untimed.
  Picoseconds drawing = 0, reading = 0;
};

}  // namespace deltaz::ars
