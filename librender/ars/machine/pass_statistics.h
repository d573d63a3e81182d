// What a timed run counted: the time of every unit by what it did, every queue, every cycle of the memories.
// Thread-safety: plain values.
#pragma once

#include <vector>

#include "formats/error.h"
#include "librender/ars/distribution/distribution_tree.h"
#include "librender/ars/machine/tiler_pipeline.h"
#include "librender/ars/memory/memory_channel.h"

namespace deltaz::ars {

struct MemoryStatistics {
  MemoryCounts counts;
  MemoryChannelStatistics channel;
};

struct PassStatistics {
  Picoseconds duration = 0;  // until the last pixel is in memory and the last sample taken
  Picoseconds reading = 0;   // after that: READ of every word, the memories side by side
  int barriers = 0;          // kept within the pass
  std::vector<TilerStatistics> tilers;
  TreeStatistics tree;
  std::vector<MemoryStatistics> memories;

  MemoryCounts memoryCounts() const;  // of all memories
  std::int64_t pixels() const;        // emitted by all tilers
  // Pixels that reached memory in 100 ns, on the average.
  double pixelsPerTreeCycle() const;
};

// Every pixel emitted was accepted, once, and every unit's time is accounted for. An Error is kInternal: the
// model is wrong.
Status verifyConservation(const PassStatistics& statistics, const CycleLengths& lengths);

}  // namespace deltaz::ars
