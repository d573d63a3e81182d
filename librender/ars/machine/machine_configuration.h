// What a machine is made of. The defaults are the report's: four tilers, eight memories, scramble, Table 10
// and the memory module as built.
// Thread-safety: plain values.
#pragma once

#include <vector>

#include "formats/error.h"
#include "librender/ars/distribution/distribution_tree.h"
#include "librender/ars/machine/tiler_pipeline.h"
#include "librender/ars/memory/memory_channel.h"

namespace deltaz::ars {

inline constexpr int kMaximumFifoDepth = 1 << 16;
// Fully loaded, no buffer waits for another to be emptied if there is one more than tilers (report 5.2).
inline constexpr int kOneBufferMoreThanTilers = 0;

struct MachineConfiguration {
  int tilers = 4, memories = 8;  // powers of two up to kMaximumTilers, kMaximumMemories
  std::vector<int> unavailable;  // tilers out of service; their pixels come from the others

  HashingMode mode = HashingMode::kScramble;
  QueueDiscipline discipline = QueueDiscipline::kInputsFirst;
  int queue_depth = kQueueDepth;  // 0..kMaximumQueueDepth

  MemoryDesign memory_design = MemoryDesign::kVariable;
  TieRule ties = TieRule::kFirstStays;
  int depth_mantissa_bits = kDepthMantissaBits;  // of the pixels' depths, 1..31: the rest is exponent
  int memory_fifo = kMemoryFifoDepth;            // FIFOs: 1..kMaximumFifoDepth

  int tiler_clock_percent = 100;  // 1..1000: of 8 MHz set-up and of 100 ns a sample
  int transfer_fifo = kTriangleQueue, set_up_fifo = kSetUpQueue, output_fifo = kPixelQueue;

  int buffers = kOneBufferMoreThanTilers;  // 1..10000, or this
  int buffer_triangles = 32;               // 1..1000000
  // Nanoseconds, 0..1000000. The report's worst case of 1200 ns a word, 9.6 us a triangle, is not the
  // default: its Table 24 has tilers that go through small triangles in 8.2 us each. A frame is computed
  // beforehand and sent "as fast as possible".
  int word_transfer = 0;
  int host_triangle = 0;  // that the host takes to make one triangle

  // Barriers in the stream are kept: what stands behind one begins when all before is in memory. The report's
  // machine has none; without them, background pixels overwrite and are overwritten as the tilers happen to
  // be.
  bool barriers = true;
};

// The host's buffers, of which there may be one more than tilers.
int bufferCount(const MachineConfiguration& configuration);

// kUsage if a value is out of its range, or if no tiler is in service.
Status validate(const MachineConfiguration& configuration);

}  // namespace deltaz::ars
