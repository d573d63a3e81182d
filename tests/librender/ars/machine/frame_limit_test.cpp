#include "librender/ars/machine/frame_limit.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "librender/ars/machine/machine.h"
#include "tests/librender/ars/machine/random_pixels.h"

namespace deltaz::ars {
namespace {

struct Limited {
  StageTimes times;
  PassStatistics statistics;
};

Limited run(const MachineConfiguration& configuration, const PixelSource& source) {
  Machine machine = Machine::make(configuration).value();
  Result<PassStatistics> statistics = machine.runTimed(source);
  if (!statistics.ok()) {
    ADD_FAILURE() << statistics.error().message();
    return {};
  }
  return {stageTimes(statistics.value(), configuration), statistics.value()};
}

// A machine for each stage that is made the slowest.
TEST(FrameLimit, is_the_stage_that_is_slowest) {
  const RecordedPixels load = randomPixels({.side = 69.7, .seed = 1});
  MachineConfiguration of_report;
  EXPECT_EQ(run(of_report, load).times.limit(), FrameStage::kTiling);
  MachineConfiguration slow_host;
  slow_host.host_triangle = 20'000;
  EXPECT_EQ(run(slow_host, load).times.limit(), FrameStage::kHost);
  MachineConfiguration slow_words;
  slow_words.word_transfer = 10'000;
  EXPECT_EQ(run(slow_words, load).times.limit(), FrameStage::kHost);
  MachineConfiguration one_memory;
  one_memory.memories = 1;
  EXPECT_EQ(run(one_memory, load).times.limit(), FrameStage::kScanOut);
  // Half as many pixels again as there are words to read, each in a cycle nearly as long as READ's.
  EXPECT_EQ(run(one_memory, randomPixels({.triangles = 5000, .side = 69.7, .seed = 1})).times.limit(),
            FrameStage::kMemories);
  MachineConfiguration fast_tiler;
  fast_tiler.tilers = 1;
  fast_tiler.memories = 64;
  fast_tiler.tiler_clock_percent = 1000;
  EXPECT_EQ(run(fast_tiler, load).times.limit(), FrameStage::kTree);
  MachineConfiguration many_memories;
  many_memories.memories = 64;
  EXPECT_EQ(run(many_memories, randomPixels({.side = 3})).times.limit(), FrameStage::kSetUp);
}

// Whatever the modes do to the queues, no stage is busier than the frame is long, and the one that limits is
// busy for a good part of it.
TEST(FrameLimit, takes_no_longer_than_the_frame) {
  const RecordedPixels load = randomPixels({.triangles = 500, .side = 69.7});
  for (const HashingMode mode :
       {HashingMode::kSequential, HashingMode::kInterleave, HashingMode::kScramble}) {
    MachineConfiguration configuration;
    configuration.mode = mode;
    configuration.queue_depth = 4;
    const Limited limited = run(configuration, load);
    Picoseconds longest = 0;
    for (std::size_t k = 0; k < kFrameStages; ++k) {
      if (static_cast<FrameStage>(k) == FrameStage::kScanOut) continue;
      EXPECT_LE(limited.times.time[k], limited.statistics.duration + kTreeCycle)
          << frameStageName(static_cast<FrameStage>(k));
      longest = std::max(longest, limited.times.time[k]);
    }
    EXPECT_GT(2 * longest, limited.statistics.duration);
    EXPECT_EQ(limited.times.time[static_cast<std::size_t>(FrameStage::kScanOut)], limited.statistics.reading);
  }
}

TEST(FrameLimit, adds_up_over_runs) {
  StageTimes sum;
  StageTimes one;
  one.time = {1, 5, 0, 0, 3, 0};
  StageTimes other;
  other.time = {1, 0, 0, 0, 3, 4};
  sum += one;
  EXPECT_EQ(sum.limit(), FrameStage::kSetUp);
  sum += other;
  EXPECT_EQ(sum.limit(), FrameStage::kMemories);
}

}  // namespace
}  // namespace deltaz::ars
