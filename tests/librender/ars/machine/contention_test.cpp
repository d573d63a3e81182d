// The digest's cycle simulation (section 7) run again: four tilers, 2000 triangles of about 128 pixels of
// which 71.4 % of the samples are pixels, centres scattered by 55 lines about mid-screen, real memory cycles,
// strict Table 10. 500 triangles a tiler, as in the report's Table 22. The digest's numbers are of one random
// set of triangles, ours of three; what depends on the set is bounded by what eight sets gave.
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>

#include "librender/ars/machine/machine.h"
#include "tests/librender/ars/machine/random_pixels.h"

namespace deltaz::ars {
namespace {

constexpr std::array kPercents = {25, 50, 75, 100};

const std::vector<RecordedPixels>& loads() {
  static const std::vector<RecordedPixels> kLoads = [] {
    std::vector<RecordedPixels> loads;
    for (const unsigned seed : {1U, 2U}) loads.push_back(randomPixels({.side = 69.7, .seed = seed}));
    return loads;
  }();
  return kLoads;
}

PassStatistics run(const RecordedPixels& load, HashingMode mode, int percent,
                   QueueDiscipline discipline = QueueDiscipline::kInputsFirst) {
  MachineConfiguration configuration;
  configuration.mode = mode;
  configuration.discipline = discipline;
  configuration.tiler_clock_percent = percent;
  configuration.buffer_triangles = 500;
  Machine machine = Machine::make(configuration).value();
  Result<PassStatistics> statistics = machine.runTimed(load);
  if (!statistics.ok()) ADD_FAILURE() << statistics.error().message();
  return statistics.ok() ? statistics.value() : PassStatistics{};
}

double overtakenPercent(const PassStatistics& statistics) {
  return 100.0 * static_cast<double>(statistics.tree.overtaken) / static_cast<double>(statistics.tree.left);
}

struct Bounds {
  int least, most;
};

// Maximum queue lengths at 25, 50, 75 and 100 % of the tilers' clock.
void expectQueues(HashingMode mode, const std::array<Bounds, 4>& bounds) {
  for (const RecordedPixels& load : loads()) {
    for (std::size_t k = 0; k < kPercents.size(); ++k) {
      const int longest = run(load, mode, kPercents[k]).tree.longestQueue();
      EXPECT_GE(longest, bounds[k].least) << kPercents[k] << " %";
      EXPECT_LE(longest, bounds[k].most) << kPercents[k] << " %";
    }
  }
}

TEST(Contention, load_is_that_of_the_digest) {
  for (const RecordedPixels& load : loads()) {
    std::int64_t pixels = 0, samples = 0;
    for (const RecordedPixels::Triangle& triangle : load.list) {
      samples += triangle.sampled.samples_after;
      for (const SampledPixel& pixel : triangle.sampled.pixels) {
        samples += pixel.samples;
        ++pixels;
      }
    }
    EXPECT_NEAR(static_cast<double>(pixels) / 2000, 128, 4);
    EXPECT_NEAR(100.0 * static_cast<double>(pixels) / static_cast<double>(samples), 71.4, 1);
  }
}

// Digest 7 and 15: 1/1/2/3; report 7.1.3.1: "almost non-existent".
TEST(Contention, scramble_needs_queues_of_three_at_most) {
  expectQueues(HashingMode::kScramble, {{{0, 3}, {0, 3}, {0, 3}, {1, 3}}});
}

// Digest 7 and 15: 48/256/256/256, the whole of the queues.
TEST(Contention, sequential_fills_its_queues) {
  expectQueues(HashingMode::kSequential, {{{30, 170}, {256, 256}, {256, 256}, {256, 256}}});
}

// Digest 7: 1/14/38/44.
TEST(Contention, interleave_needs_queues_in_between) {
  expectQueues(HashingMode::kInterleave, {{{0, 2}, {8, 30}, {20, 70}, {30, 100}}});
}

// Digest 7: 1.28, 2.67, 2.70 pixels in 100 ns at the full clock.
TEST(Contention, throughput_is_that_of_the_digest) {
  for (const RecordedPixels& load : loads()) {
    EXPECT_NEAR(run(load, HashingMode::kSequential, 100).pixelsPerTreeCycle(), 1.28, 0.05);
    EXPECT_NEAR(run(load, HashingMode::kInterleave, 100).pixelsPerTreeCycle(), 2.67, 0.08);
    EXPECT_NEAR(run(load, HashingMode::kScramble, 100).pixelsPerTreeCycle(), 2.70, 0.08);
  }
}

// Digest 7: 22 %, 4.5 %, .02 %, and none if the queue is served first.
TEST(Contention, strict_discipline_reorders_as_the_digest_says) {
  for (const RecordedPixels& load : loads()) {
    EXPECT_NEAR(overtakenPercent(run(load, HashingMode::kSequential, 100)), 22, 2.5);
    EXPECT_NEAR(overtakenPercent(run(load, HashingMode::kInterleave, 100)), 4.5, 0.6);
    EXPECT_NEAR(overtakenPercent(run(load, HashingMode::kScramble, 100)), 0.02, 0.015);
  }
  for (const HashingMode mode : {HashingMode::kSequential, HashingMode::kInterleave, HashingMode::kScramble})
    EXPECT_EQ(run(loads()[0], mode, 100, QueueDiscipline::kQueueFirst).tree.overtaken, 0);
}

// Digest 8: 168.5 ns with depths log-uniform over three octaves.
TEST(Contention, average_memory_cycle_is_168_5_nanoseconds) {
  for (const RecordedPixels& load : loads()) {
    const PassStatistics statistics = run(load, HashingMode::kScramble, 100);
    EXPECT_NEAR(averageCycle(statistics.memoryCounts().cycles, cycleLengths(MemoryDesign::kVariable)), 168.5,
                1.2);
  }
}

// Digest 7, the exception: large triangles of which nearly every sample is a pixel. Interleave saturates
// then, scramble does not, and the machine comes near its forty million pixels a second.
TEST(Contention, large_triangles_saturate_interleave_and_not_scramble) {
  RecordedPixels load;
  std::mt19937 random(40);
  constexpr int kSide = 90;
  for (std::uint32_t k = 0; k < 150; ++k) {
    RecordedPixels::Triangle triangle;
    triangle.set_up = 8630 * kNanosecond;
    const auto top = random() % (kScreenLines - kSide), left = random() % (kScreenPixels - kSide);
    const std::uint32_t depth = (20 + k % 3) << 19 | k;
    for (unsigned i = 0; i < kSide; ++i) {
      for (unsigned j = 0; j < kSide - i; ++j) {
        PixelPacket packet;
        packet.i = static_cast<std::uint16_t>(top + i);
        packet.j = static_cast<std::uint16_t>(left + j);
        packet.depth = depth;
        triangle.sampled.pixels.push_back({.samples = 1, .packet = packet});
      }
    }
    load.list.push_back(triangle);
  }
  const auto run_in = [&load](HashingMode mode) {
    MachineConfiguration configuration;
    configuration.mode = mode;
    configuration.buffer_triangles = 2;
    return Machine::make(configuration).value().runTimed(load).value();
  };
  const PassStatistics interleave = run_in(HashingMode::kInterleave),
                       scramble = run_in(HashingMode::kScramble);
  EXPECT_GT(interleave.tree.longestQueue(), 100);
  EXPECT_LT(interleave.pixelsPerTreeCycle(), 3.6);
  EXPECT_LE(scramble.tree.longestQueue(), 6);
  EXPECT_GT(scramble.pixelsPerTreeCycle(), 3.8);
}

// Digest 7, Fig 92: 180 .. 94,762 accesses a memory become 32,009 .. 32,101.
TEST(Contention, scramble_evens_out_the_memories) {
  const auto extremes = [](HashingMode mode) {
    const PassStatistics statistics = run(loads()[0], mode, 100);
    std::vector<std::int64_t> accesses;
    for (const MemoryStatistics& memory : statistics.memories) accesses.push_back(memory.counts.writes());
    return std::pair(*std::min_element(accesses.begin(), accesses.end()),
                     *std::max_element(accesses.begin(), accesses.end()));
  };
  const auto [fewest_banded, most_banded] = extremes(HashingMode::kSequential);
  EXPECT_LT(fewest_banded, 500);
  EXPECT_GT(most_banded, 90'000);
  const auto [fewest, most] = extremes(HashingMode::kScramble);
  EXPECT_LT(static_cast<double>(most) / static_cast<double>(fewest), 1.01);
}

}  // namespace
}  // namespace deltaz::ars
