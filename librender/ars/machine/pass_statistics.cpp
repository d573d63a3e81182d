#include "librender/ars/machine/pass_statistics.h"

#include <fmt/format.h>
#include <numeric>
#include <string>

namespace deltaz::ars {

namespace {

Status expectEqual(std::int64_t value, std::int64_t expected, const std::string& where, const char* what) {
  if (value == expected) return Success{};
  return internalError(where, fmt::format("{}: {} where {} are expected", what, value, expected));
}

Status verifyRegisters(const std::vector<RegisterStatistics>& registers, const TreeStatistics& tree,
                       const std::string& where) {
  std::int64_t passed = 0;
  for (const RegisterStatistics& one : registers) {
    DELTAZ_TRY(expectEqual(one.sum(), tree.cycles, where, "cycles in all states"));
    passed += one.busy;
  }
  return expectEqual(passed, tree.left, where, "pixels passed");
}

Status verifyTree(const TreeStatistics& tree) {
  DELTAZ_TRY(expectEqual(tree.left, tree.entered, "distribution tree", "pixels out"));
  DELTAZ_TRY(verifyRegisters(tree.outlets, tree, "outlets of the distribution tree"));
  for (std::size_t l = 0; l < tree.levels.size(); ++l) {
    const TreeLevelStatistics& level = tree.levels[l];
    const std::string where = fmt::format("level {} of the distribution tree", l);
    DELTAZ_TRY(verifyRegisters(level.inputs, tree, where));
    if (level.kind == CellKind::kSplit) {
      DELTAZ_TRY(verifyRegisters(level.buffers, tree, where));
      continue;
    }
    std::int64_t passed = 0;
    for (const QueueStatistics& queue : level.queues) {
      passed += queue.direct + queue.queued;
      DELTAZ_TRY(expectEqual(
          std::accumulate(queue.cycles_at_length.begin(), queue.cycles_at_length.end(), std::int64_t{0}),
          tree.cycles, where, "cycles at all queue lengths"));
    }
    DELTAZ_TRY(expectEqual(passed, tree.left, where, "pixels direct and queued"));
  }
  return Success{};
}

}  // namespace

MemoryCounts PassStatistics::memoryCounts() const {
  MemoryCounts sum;
  for (const MemoryStatistics& memory : memories) sum += memory.counts;
  return sum;
}

std::int64_t PassStatistics::pixels() const {
  std::int64_t sum = 0;
  for (const TilerStatistics& tiler : tilers) sum += tiler.pixels;
  return sum;
}

double PassStatistics::pixelsPerTreeCycle() const {
  return duration > 0
             ? static_cast<double>(pixels()) * static_cast<double>(kTreeCycle) / static_cast<double>(duration)
             : 0;
}

Status verifyConservation(const PassStatistics& statistics, const CycleLengths& lengths) {
  for (std::size_t t = 0; t < statistics.tilers.size(); ++t) {
    const TilerStatistics& tiler = statistics.tilers[t];
    const std::string where = fmt::format("tiler {}", t);
    DELTAZ_TRY(expectEqual(tiler.transfer.sum(), statistics.duration, where, "picoseconds of transfer"));
    DELTAZ_TRY(expectEqual(tiler.set_up.sum(), statistics.duration, where, "picoseconds of set-up"));
    DELTAZ_TRY(expectEqual(tiler.tiling.sum(), statistics.duration, where, "picoseconds of tiling"));
  }
  DELTAZ_TRY(expectEqual(statistics.tree.entered, statistics.pixels(), "tilers", "pixels accepted"));
  DELTAZ_TRY(verifyTree(statistics.tree));
  DELTAZ_TRY(expectEqual(statistics.memoryCounts().writes(), statistics.tree.left, "memories", "cycles"));
  for (std::size_t m = 0; m < statistics.memories.size(); ++m) {
    const MemoryStatistics& memory = statistics.memories[m];
    const std::string where = fmt::format("memory {}", m);
    DELTAZ_TRY(expectEqual(memory.channel.busy + memory.channel.starved, statistics.duration, where,
                           "picoseconds in all states"));
    Picoseconds busy = 0;
    for (std::size_t k = 0; k < kWriteCycleCount; ++k)
      busy += memory.counts.cycles[k] * lengths.nanoseconds[k] * kNanosecond;
    DELTAZ_TRY(expectEqual(memory.channel.busy, busy, where, "picoseconds of its cycles"));
  }
  return Success{};
}

}  // namespace deltaz::ars
