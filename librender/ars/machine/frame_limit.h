// What a frame waits for: how long each stage of the machine would take if none of the others made it wait.
//
// The longest of them limits the frame: whatever else is made faster, it takes no less. Runs come one after
// the other, so their times are added. Thread-safety: plain values and pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "librender/ars/machine/machine_configuration.h"
#include "librender/ars/machine/pass_statistics.h"

namespace deltaz::ars {

// In the order of the way through the machine.
enum class FrameStage : std::uint8_t { kHost, kSetUp, kTiling, kTree, kMemories, kScanOut };
inline constexpr std::size_t kFrameStages = 6;
std::string_view frameStageName(FrameStage stage);  // "host", "set-up", "tiling", "tree", ...

// Of each stage the time of its busiest unit. Host: making triangles, or sending their words if that is
// longer. Tree: a register that passes pixels on or has lost to another. Scan-out: READ of every word.
struct StageTimes {
  std::array<Picoseconds, kFrameStages> time{};

  StageTimes& operator+=(const StageTimes& other);
  // The longest; of equally long ones the first.
  FrameStage limit() const;
};

StageTimes stageTimes(const PassStatistics& statistics, const MachineConfiguration& configuration);

}  // namespace deltaz::ars
