#include "librender/ars/memory/memory_channel.h"

#include <algorithm>
#include <cassert>

namespace deltaz::ars {

MemoryChannel::MemoryChannel(MemoryModule& module, const CycleLengths& lengths, int fifo_depth)
    : module_(module),
      begins_(static_cast<std::size_t>(fifo_depth)),
      found_(static_cast<std::size_t>(fifo_depth)) {
  assert(fifo_depth >= 1);
  for (std::size_t k = 0; k < kMemoryCycleCount; ++k) length_[k] = lengths.nanoseconds[k] * kNanosecond;
}

void MemoryChannel::accept(std::uint32_t address, std::uint64_t word, bool background, Picoseconds now) {
  assert(hasRoom(now));
  const std::size_t depth = begins_.size();
  while (waiting_ > 0 && begins_[oldest_] <= now) {
    oldest_ = oldest_ + 1 == depth ? 0 : oldest_ + 1;
    --waiting_;
  }
  ++found_[static_cast<std::size_t>(waiting_)];

  const Picoseconds begin = std::max(now, idle_at_);
  starved_ += begin - idle_at_;
  const Picoseconds length = length_[static_cast<std::size_t>(module_.write(address, word, background))];
  busy_ += length;
  idle_at_ = begin + length;

  begins_[slot_] = begin;
  if (waiting_ == 0) oldest_ = slot_;
  slot_ = slot_ + 1 == depth ? 0 : slot_ + 1;
  high_water_ = std::max(high_water_, ++waiting_);
  ++accepted_;
}

MemoryChannelStatistics MemoryChannel::statistics(Picoseconds end) const {
  assert(end >= idle_at_);
  return {.busy = busy_, .starved = starved_ + end - idle_at_, .high_water = high_water_, .found = found_};
}

}  // namespace deltaz::ars
