#include "librender/ars/machine/frame_limit.h"

#include <algorithm>
#include <cstddef>

namespace deltaz::ars {

std::string_view frameStageName(FrameStage stage) {
  constexpr std::array<std::string_view, kFrameStages> kNames = {"host", "set-up",   "tiling",
                                                                 "tree", "memories", "scan-out"};
  return kNames[static_cast<std::size_t>(stage)];
}

StageTimes& StageTimes::operator+=(const StageTimes& other) {
  for (std::size_t k = 0; k < time.size(); ++k) time[k] += other.time[k];
  return *this;
}

FrameStage StageTimes::limit() const {
  return static_cast<FrameStage>(std::max_element(time.begin(), time.end()) - time.begin());
}

StageTimes stageTimes(const PassStatistics& statistics, const MachineConfiguration& configuration) {
  StageTimes times;
  const auto at_least = [&times](FrameStage stage, Picoseconds time) {
    Picoseconds& longest = times.time[static_cast<std::size_t>(stage)];
    longest = std::max(longest, time);
  };
  std::int64_t triangles = 0;
  for (const TilerStatistics& tiler : statistics.tilers) {
    triangles += tiler.triangles;
    at_least(FrameStage::kHost, tiler.transfer.busy);
    at_least(FrameStage::kSetUp, tiler.set_up.busy);
    at_least(FrameStage::kTiling, tiler.tiling.busy);
  }
  at_least(FrameStage::kHost, triangles * configuration.host_triangle * kNanosecond);
  const auto add_registers = [&](const std::vector<RegisterStatistics>& registers) {
    for (const RegisterStatistics& each : registers)
      at_least(FrameStage::kTree, (each.busy + each.lost) * kTreeCycle);
  };
  for (const TreeLevelStatistics& level : statistics.tree.levels) {
    add_registers(level.inputs);
    add_registers(level.buffers);
  }
  add_registers(statistics.tree.outlets);
  for (const MemoryStatistics& memory : statistics.memories)
    at_least(FrameStage::kMemories, memory.channel.busy);
  at_least(FrameStage::kScanOut, statistics.reading);
  return times;
}

}  // namespace deltaz::ars
