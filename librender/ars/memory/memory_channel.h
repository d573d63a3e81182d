// A memory module with the FIFO before it, in time: the tree-memory interface (report 4.3.5.1). The module
// runs by no clock: a pixel's cycle begins as soon as the pixel has arrived and the cycle before has ended,
// and it leaves the FIFO when its cycle begins.
//
// Nothing that comes later changes when a pixel is served, so its cycle is run when it arrives and only times
// are kept. Thread-safety: one thread a channel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "librender/ars/memory/memory_module.h"
#include "librender/ars/simulated_time.h"

namespace deltaz::ars {

inline constexpr int kMemoryFifoDepth = 64;  // report 4.3.5.1

struct MemoryChannelStatistics {
  Picoseconds busy = 0, starved = 0;  // up to the end asked for: in a cycle, waiting for pixels
  int high_water = 0;                 // most pixels in the FIFO
  // By number of pixels in the FIFO just before one comes: how often.
  std::vector<std::int64_t> found;
};

class MemoryChannel {
 public:
  // The module outlives the channel.
  MemoryChannel(MemoryModule& module, const CycleLengths& lengths, int fifo_depth = kMemoryFifoDepth);

  // Whether the FIFO has room at `now`.
  bool hasRoom(Picoseconds now) const {
    return accepted_ < static_cast<std::int64_t>(begins_.size()) || begins_[slot_] <= now;
  }
  // A pixel comes at `now`, no earlier than the one before; the FIFO has room.
  void accept(std::uint32_t address, std::uint64_t word, bool background, Picoseconds now);

  std::int64_t accepted() const { return accepted_; }
  // When the last cycle so far ends; 0 if there was none.
  Picoseconds idleAt() const { return idle_at_; }
  // Until `end` >= idleAt().
  MemoryChannelStatistics statistics(Picoseconds end) const;

 private:
  MemoryModule& module_;
  std::array<Picoseconds, kMemoryCycleCount> length_{};
  std::vector<Picoseconds> begins_;  // ring: when the last fifo_depth pixels' cycles begin
  std::size_t slot_ = 0;             // of the next pixel
  std::size_t oldest_ = 0;           // slot of the first pixel that may still wait
  int waiting_ = 0;
  std::int64_t accepted_ = 0;
  Picoseconds idle_at_ = 0, busy_ = 0, starved_ = 0;
  int high_water_ = 0;
  std::vector<std::int64_t> found_;
};

}  // namespace deltaz::ars
