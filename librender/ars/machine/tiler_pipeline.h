// One tiler in time: transfer from the host, FIFO, set-up, FIFO, tiling machine, output FIFO (report 4.2.4,
// 7.1.2.1). Set-up and tiling work on different triangles at once.
//
// Nothing is stepped. When a stage begins and ends with a triangle is the maximum of when its input is there,
// when it is done with the triangle before, and when there is room behind it; room in the output FIFO comes
// from the distribution tree, and the tiler is worked out as far ahead of the tree as that allows.
// Cost: some ten nanoseconds a pixel. Thread-safety: one thread a tiler.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "librender/ars/distribution/distribution_tree.h"
#include "librender/ars/machine/pixel_source.h"
#include "librender/ars/tiler/tiler_timing.h"

namespace deltaz::ars {

struct TilerPipelineTiming {
  Picoseconds transfer = 0;  // of a triangle's eight words from the host
  Picoseconds load = kTilingLoad;
  Picoseconds sample = kSamplePixel;
  int transfer_fifo = kTriangleQueue, set_up_fifo = kSetUpQueue;  // triangles
  int output_fifo = kPixelQueue;                                  // pixels
  int clock_percent = 100;  // of set-up and tiling machine: their times are divided by it
};

// How a unit spends its time; the sum is that of the frame.
struct UnitTimes {
  Picoseconds busy = 0;
  Picoseconds starved = 0;  // nothing to do
  Picoseconds blocked = 0;  // done, and no room behind
  Picoseconds sum() const { return busy + starved + blocked; }
};

struct TilerStatistics {
  std::int64_t triangles = 0, samples = 0, pixels = 0;
  UnitTimes transfer = {}, set_up = {}, tiling = {};
  Picoseconds loading = 0;    // of tiling.busy: the rest is sampling
  int output_high_water = 0;  // most pixels in the output FIFO
};

class TilerPipeline {
 public:
  // Source and map outlive the tiler.
  TilerPipeline(int number, const PixelSource& source, const MemoryMap& map,
                const TilerPipelineTiming& timing);

  // Triangles begin .. end - 1 of the source are transferred from `from` on. All before have been.
  void assign(std::size_t begin, std::size_t end, Picoseconds from);
  // When the last word of what was assigned has been transferred; kNever while that is not known.
  Picoseconds transferred() const { return transferred_ == passages_.size() ? transfer_end_ : kNever; }

  // When the next pixel is in the output FIFO; kNever if none is known of.
  Picoseconds ready() const { return made_ > taken_ ? ready_[slotOf(taken_)] : kNever; }
  // Takes it, at `now` >= ready().
  TreePixel take(Picoseconds now);

  // Nothing assigned is left to tile or to take.
  bool finished() const { return made_ == taken_ && loaded_ == passages_.size() && !tiling_; }
  // When the last triangle so far was done; finished().
  Picoseconds idleAt() const { return tiled_until_; }
  // Until `end` >= idleAt(); finished().
  TilerStatistics statistics(Picoseconds end) const;

 private:
  // A triangle's way through the tiler, as far as it is known.
  struct Passage {
    std::size_t triangle = 0;
    Picoseconds transferred = 0, set_up_begun = 0, set_up = 0, loaded = 0;
  };

  std::size_t slotOf(std::int64_t pixel) const { return static_cast<std::size_t>(pixel) % ready_.size(); }
  Picoseconds scaled(Picoseconds time) const;
  void advance();
  bool transferNext();
  bool beginSetUp();
  bool endSetUp();
  bool loadNext();
  bool tile();

  int number_;
  const PixelSource& source_;
  MemoryMap map_;
  TilerPipelineTiming timing_;
  Picoseconds load_, sample_;  // scaled

  std::vector<Passage> passages_;                                               // of all triangles assigned
  std::size_t transferred_ = 0, set_ups_begun_ = 0, set_ups_ = 0, loaded_ = 0;  // how many of them
  Picoseconds assigned_at_ = 0, transfer_end_ = 0, set_up_end_ = 0;             // of the last one

  SampledTriangle sampled_;     // the one being tiled
  std::size_t next_pixel_ = 0;  // of it
  bool tiling_ = false;
  Picoseconds tiled_until_ = 0;

  // Rings: when the last pixels came into the output FIFO and when they left it, and what they are.
  std::vector<Picoseconds> ready_, left_;
  std::vector<TreePixel> output_;
  std::int64_t made_ = 0, arrived_ = 0, taken_ = 0;  // arrived_: before the last take
  TilerStatistics statistics_;
};

}  // namespace deltaz::ars
