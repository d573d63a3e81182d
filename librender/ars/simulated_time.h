// Time in the machine, counted from the beginning of a frame. Integers, so that runs repeat to the last bit;
// picoseconds, so that tiler clocks of three quarters of the nominal one (133.333 ns) are near enough.
#pragma once

#include <cstdint>
#include <limits>

namespace deltaz::ars {

using Picoseconds = std::int64_t;
inline constexpr Picoseconds kNanosecond = 1000, kMicrosecond = 1000 * kNanosecond,
                             kMillisecond = 1000 * kMicrosecond;
inline constexpr Picoseconds kNever = std::numeric_limits<Picoseconds>::max() / 4;

// The clock of the distribution tree, 10 MHz (report 4.3.5). Cycle n begins at n * kTreeCycle.
inline constexpr Picoseconds kTreeCycle = 100 * kNanosecond;

// The first cycle that begins at `time` or later; time >= 0.
constexpr std::int64_t treeCycleAt(Picoseconds time) {
  return (time + kTreeCycle - 1) / kTreeCycle;
}

}  // namespace deltaz::ars
