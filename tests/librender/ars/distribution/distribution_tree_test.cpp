#include "librender/ars/distribution/distribution_tree.h"

#include <array>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <tuple>
#include <vector>

namespace deltaz::ars {
namespace {

struct Sent {
  std::int64_t cycle = 0;  // from which on it can be taken
  TreePixel pixel;
};

class ListedInlets final : public TreeInlets {
 public:
  explicit ListedInlets(int tilers) : lists_(static_cast<std::size_t>(tilers)), next_(lists_.size()) {}

  void add(int tiler, int memory, std::int64_t cycle) {
    std::vector<Sent>& list = lists_[static_cast<std::size_t>(tiler)];
    TreePixel pixel;
    pixel.memory = static_cast<std::uint8_t>(memory);
    pixel.tiler = static_cast<std::uint8_t>(tiler);
    pixel.sequence = static_cast<std::uint32_t>(list.size()) + 1;
    pixel.word = pixel.sequence * 64 + static_cast<std::uint32_t>(tiler);
    list.push_back({cycle, pixel});
  }
  std::int64_t readyCycle(int tiler) override {
    const auto at = static_cast<std::size_t>(tiler);
    return next_[at] < lists_[at].size() ? lists_[at][next_[at]].cycle : kNoCycle;
  }
  TreePixel take(int tiler, std::int64_t cycle) override {
    const auto at = static_cast<std::size_t>(tiler);
    const Sent& sent = lists_[at][next_[at]++];
    EXPECT_LE(sent.cycle, cycle);
    return sent.pixel;
  }
  std::int64_t total() const {
    std::int64_t sum = 0;
    for (const auto& list : lists_) sum += static_cast<std::int64_t>(list.size());
    return sum;
  }

 private:
  std::vector<std::vector<Sent>> lists_;
  std::vector<std::size_t> next_;
};

// Takes a pixel a memory every `period` cycles.
class SlowOutlets final : public TreeOutlets {
 public:
  explicit SlowOutlets(int memories, std::int64_t period)
      : free_(static_cast<std::size_t>(memories)), period_(period) {}

  bool offer(int memory, const TreePixel& pixel, std::int64_t cycle) override {
    EXPECT_EQ(memory, pixel.memory);
    if (free_[pixel.memory] > cycle) return false;
    free_[pixel.memory] = cycle + period_;
    arrived.push_back({cycle, pixel});
    return true;
  }
  std::vector<Sent> arrived;

 private:
  std::vector<std::int64_t> free_;
  std::int64_t period_;
};

std::int64_t runToEnd(DistributionTree& tree, std::int64_t limit = 1'000'000) {
  std::int64_t cycle = tree.nextCycle(0);
  for (; cycle != TreeInlets::kNoCycle && cycle < limit; cycle = tree.nextCycle(cycle + 1)) tree.run(cycle);
  EXPECT_EQ(cycle, TreeInlets::kNoCycle) << "pixels are stuck";
  return tree.empty() ? cycle : -1;
}

void expectConservation(const TreeStatistics& statistics) {
  EXPECT_EQ(statistics.entered, statistics.left);
  const auto sums = [&](const std::vector<RegisterStatistics>& registers, const char* what) {
    std::int64_t busy = 0;
    for (const RegisterStatistics& one : registers) {
      EXPECT_EQ(one.sum(), statistics.cycles) << what;
      EXPECT_GE(one.starved, 0);
      busy += one.busy;
    }
    EXPECT_EQ(busy, statistics.entered) << what;  // every pixel passes one register of a kind and level
  };
  sums(statistics.outlets, "outlets");
  for (const TreeLevelStatistics& level : statistics.levels) {
    sums(level.inputs, "inputs");
    if (!level.buffers.empty()) sums(level.buffers, "buffers");
    for (const QueueStatistics& queue : level.queues) {
      std::int64_t cycles = 0;
      for (const std::int64_t at_length : queue.cycles_at_length) cycles += at_length;
      EXPECT_EQ(cycles, statistics.cycles);
    }
  }
}

TEST(DistributionTree, carries_a_pixel_a_cycle_without_a_gap) {
  ListedInlets inlets(4);
  for (int k = 0; k < 100; ++k) inlets.add(0, 5, 0);
  SlowOutlets outlets(8, 1);
  DistributionTree tree(4, 8, inlets, outlets);
  runToEnd(tree);
  ASSERT_EQ(outlets.arrived.size(), 100U);
  // T, B, TAL of the A-cell, TAL of two B-cells: five registers.
  for (std::size_t k = 0; k < 100; ++k) EXPECT_EQ(outlets.arrived[k].cycle, static_cast<std::int64_t>(k) + 5);
  EXPECT_EQ(tree.statistics(200).longestQueue(), 0);
}

// Table 10: of two pixels for one output the left one goes first, then the right one.
TEST(DistributionTree, serves_the_upper_left_pixel_first) {
  ListedInlets inlets(2);
  inlets.add(1, 0, 0);
  inlets.add(0, 0, 0);
  SlowOutlets outlets(2, 1);
  DistributionTree tree(2, 2, inlets, outlets);
  runToEnd(tree);
  ASSERT_EQ(outlets.arrived.size(), 2U);
  EXPECT_EQ(outlets.arrived[0].pixel.tiler, 0);
  EXPECT_EQ(outlets.arrived[1].pixel.tiler, 1);
  EXPECT_EQ(outlets.arrived[1].cycle, outlets.arrived[0].cycle + 1);
  const TreeStatistics statistics = tree.statistics(10);
  EXPECT_EQ(statistics.levels[0].inputs[0].lost, 0);
  EXPECT_EQ(statistics.levels[0].inputs[1].lost, 1);
}

// Table 10 asks the queue last, so a pixel that comes while the output is free overtakes those queued.
TEST(DistributionTree, strict_discipline_lets_pixels_overtake_and_queue_first_does_not) {
  for (const QueueDiscipline discipline : {QueueDiscipline::kInputsFirst, QueueDiscipline::kQueueFirst}) {
    ListedInlets inlets(2);
    for (int k = 0; k < 50; ++k) inlets.add(0, 0, k);
    SlowOutlets outlets(2, 3);
    DistributionTree tree(2, 2, inlets, outlets, discipline);
    runToEnd(tree);
    ASSERT_EQ(outlets.arrived.size(), 50U);
    const TreeStatistics statistics = tree.statistics(1000);
    expectConservation(statistics);
    EXPECT_GT(statistics.longestQueue(), 10);
    if (discipline == QueueDiscipline::kInputsFirst) {
      EXPECT_GT(statistics.overtaken, 0);
    } else {
      EXPECT_EQ(statistics.overtaken, 0);
    }
  }
}

TEST(DistributionTree, holds_no_more_than_the_queue_limit) {
  for (const int depth : {0, 1, 2, 7}) {
    ListedInlets inlets(4);
    for (int tiler = 0; tiler < 4; ++tiler)
      for (int k = 0; k < 100; ++k) inlets.add(tiler, 3, 0);
    SlowOutlets outlets(8, 2);
    DistributionTree tree(4, 8, inlets, outlets, QueueDiscipline::kInputsFirst, depth);
    runToEnd(tree);
    EXPECT_EQ(outlets.arrived.size(), 400U);
    EXPECT_EQ(tree.statistics(5000).longestQueue(), depth);
  }
}

TEST(DistributionTree, counts_the_time_in_which_nothing_comes_as_starved) {
  ListedInlets inlets(1);
  inlets.add(0, 0, 1000);
  inlets.add(0, 0, 5000);
  SlowOutlets outlets(1, 1);
  DistributionTree tree(1, 1, inlets, outlets);
  EXPECT_EQ(tree.nextCycle(0), 1000);
  runToEnd(tree);
  const TreeStatistics statistics = tree.statistics(6000);
  expectConservation(statistics);
  EXPECT_EQ(statistics.outlets[0].busy, 2);
  EXPECT_EQ(statistics.outlets[0].starved, 5998);
}

// Loads of all kinds, from hot spots to even ones, through trees of all shapes with hardly any queues: all
// pixels arrive once, where they should, and all time is accounted for.
TEST(DistributionTree, neither_loses_nor_stops_on_random_loads_with_small_queues) {
  std::mt19937 random(83);
  const auto below = [&random](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int trial = 0; trial < 150; ++trial) {
    const int tilers = 1 << below(7), memories = 1 << below(7);
    const QueueDiscipline discipline =
        below(2) == 0 ? QueueDiscipline::kInputsFirst : QueueDiscipline::kQueueFirst;
    const int depth = std::array{0, 1, 2, 256}[static_cast<std::size_t>(below(4))];
    const int spread = 1 + below(memories), gap = 1 + below(3);
    SCOPED_TRACE(testing::Message() << tilers << " x " << memories << ", queues of " << depth << ", "
                                    << queueDisciplineName(discipline));
    ListedInlets inlets(tilers);
    std::map<std::tuple<int, std::uint32_t>, int> sent;  // tiler, word -> memory
    for (int tiler = 0; tiler < tilers; ++tiler) {
      std::int64_t cycle = below(50);
      for (int k = below(200); k > 0; --k) {
        const int memory = below(spread);
        inlets.add(tiler, memory, cycle);
        cycle += below(gap);
      }
    }
    SlowOutlets outlets(memories, 1 + below(4));
    DistributionTree tree(tilers, memories, inlets, outlets, discipline, depth);
    runToEnd(tree);
    ASSERT_TRUE(tree.empty());
    ASSERT_EQ(static_cast<std::int64_t>(outlets.arrived.size()), inlets.total());
    for (const Sent& arrived : outlets.arrived)
      ASSERT_TRUE(
          sent.emplace(std::tuple(arrived.pixel.tiler, arrived.pixel.word), arrived.pixel.memory).second);
    const TreeStatistics statistics = tree.statistics(1'000'000);
    expectConservation(statistics);
    EXPECT_LE(statistics.longestQueue(), depth);
    if (discipline == QueueDiscipline::kQueueFirst || tilers * memories == 1) {
      EXPECT_EQ(statistics.overtaken, 0);
    }
  }
}

}  // namespace
}  // namespace deltaz::ars
