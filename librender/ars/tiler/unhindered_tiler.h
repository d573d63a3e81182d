// When a tiler's triangles are done, if nothing behind it ever stops it: set-up and tiling machine work at
// the same time, and the queue between them (report 4.2.4.2) evens out triangles that take long in one and
// short in the other.
//
// Thread-safety: each pipeline by itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "librender/ars/tiler/tiler_timing.h"

namespace deltaz::ars {

class UnhinderedTiler {
 public:
  // The next triangle; it is there as soon as set-up is free.
  void add(bool oversample, std::int64_t sampled_pixels) {
    // A set-up triangle waits in its place until the queue has room: until the one so many before has been
    // loaded.
    const std::size_t slot = static_cast<std::size_t>(count_++) % loaded_.size();
    const Picoseconds ready = set_up_free_ + setUpTime(oversample);
    const Picoseconds leaves = std::max(ready, loaded_[slot]);
    const Picoseconds start = std::max(leaves, tiling_free_);
    set_up_free_ = leaves;
    loaded_[slot] = start;
    tiling_free_ = start + tilingTime(sampled_pixels);
  }
  std::int64_t triangles() const { return count_; }
  Picoseconds end() const { return tiling_free_; }  // of the last

 private:
  std::array<Picoseconds, kSetUpQueue> loaded_{};  // when the triangle in each place of the queue left it
  Picoseconds set_up_free_ = 0, tiling_free_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace deltaz::ars
