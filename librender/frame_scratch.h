// Memory that a frame of the fast engine needs and gives back, so that the next one finds it warm.
//
// Thread-safety: FrameScratchPool from any thread; a FrameScratch is one frame's.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "librender/raster/tile_bins.h"
#include "librender/raster/tiler.h"

namespace deltaz {

struct FrameScratch {
  Tiler tiler;
  std::vector<std::unique_ptr<TileBins>> bins;  // of the batches drawn so far, and spare ones
};

class FrameScratchPool {
 public:
  // A scratch of the pool's until the lease ends; a new one if all are in use. The pool must live as long.
  class Lease {
   public:
    explicit Lease(FrameScratchPool& pool) : pool_(pool), scratch_(pool.take()) {}
    ~Lease() { pool_.giveBack(std::move(scratch_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    FrameScratch& operator*() const { return *scratch_; }

   private:
    FrameScratchPool& pool_;
    std::unique_ptr<FrameScratch> scratch_;
  };

 private:
  std::unique_ptr<FrameScratch> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<FrameScratch>();
    std::unique_ptr<FrameScratch> scratch = std::move(free_.back());
    free_.pop_back();
    return scratch;
  }
  void giveBack(std::unique_ptr<FrameScratch> scratch) noexcept {
    const std::lock_guard lock(mutex_);
    try {
      free_.push_back(std::move(scratch));
    } catch (...) {  // no room to remember it: it is freed
    }
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<FrameScratch>> free_;
};

}  // namespace deltaz
