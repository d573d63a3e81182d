#include "librender/ars/machine/tiler_pipeline.h"

#include <algorithm>
#include <cassert>

#include "librender/ars/memory/memory_module.h"

namespace deltaz::ars {

TilerPipeline::TilerPipeline(int number, const PixelSource& source, const MemoryMap& map,
                             const TilerPipelineTiming& timing)
    : number_(number),
      source_(source),
      map_(map),
      timing_(timing),
      load_(scaled(timing.load)),
      sample_(scaled(timing.sample)),
      ready_(static_cast<std::size_t>(timing.output_fifo)),
      left_(ready_.size()),
      output_(ready_.size()) {
  assert(timing.transfer_fifo >= 1 && timing.set_up_fifo >= 1 && timing.output_fifo >= 1);
}

Picoseconds TilerPipeline::scaled(Picoseconds time) const {
  return (time * 100 + timing_.clock_percent / 2) / timing_.clock_percent;
}

void TilerPipeline::assign(std::size_t begin, std::size_t end, Picoseconds from) {
  assert(transferred_ == passages_.size());
  for (std::size_t triangle = begin; triangle < end; ++triangle) passages_.push_back({.triangle = triangle});
  statistics_.triangles += static_cast<std::int64_t>(end - begin);
  assigned_at_ = from;
  advance();
}

void TilerPipeline::advance() {
  bool again = true;
  while (again) {
    again = transferNext();
    again |= beginSetUp();
    again |= endSetUp();
    again |= loadNext();
    again |= tile();
  }
}

bool TilerPipeline::transferNext() {
  const std::size_t n = transferred_, fifo = static_cast<std::size_t>(timing_.transfer_fifo);
  if (n == passages_.size() || (n >= fifo && set_ups_begun_ + fifo <= n)) return false;
  const Picoseconds room = n >= fifo ? passages_[n - fifo].set_up_begun : 0;
  const Picoseconds here = std::max(transfer_end_, assigned_at_), begin = std::max(here, room);
  statistics_.transfer.starved += here - transfer_end_;
  statistics_.transfer.blocked += begin - here;
  statistics_.transfer.busy += timing_.transfer;
  transfer_end_ = passages_[n].transferred = begin + timing_.transfer;
  ++transferred_;
  return true;
}

bool TilerPipeline::beginSetUp() {
  const std::size_t n = set_ups_begun_;
  if (n == transferred_ || set_ups_ < n) return false;
  const Picoseconds begin = std::max(passages_[n].transferred, set_up_end_);
  statistics_.set_up.starved += begin - set_up_end_;
  passages_[n].set_up_begun = begin;
  ++set_ups_begun_;
  return true;
}

bool TilerPipeline::endSetUp() {
  const std::size_t n = set_ups_, fifo = static_cast<std::size_t>(timing_.set_up_fifo);
  if (n == set_ups_begun_ || (n >= fifo && loaded_ + fifo <= n)) return false;
  const Picoseconds room = n >= fifo ? passages_[n - fifo].loaded : 0;
  const Picoseconds length = scaled(source_.setUpTime(passages_[n].triangle));
  const Picoseconds done = passages_[n].set_up_begun + length;
  set_up_end_ = passages_[n].set_up = std::max(done, room);
  statistics_.set_up.busy += length;
  statistics_.set_up.blocked += set_up_end_ - done;
  ++set_ups_;
  return true;
}

bool TilerPipeline::loadNext() {
  const std::size_t n = loaded_;
  if (tiling_ || n == set_ups_) return false;
  const Picoseconds begin = std::max(passages_[n].set_up, tiled_until_);
  statistics_.tiling.starved += begin - tiled_until_;
  statistics_.tiling.busy += load_;
  statistics_.loading += load_;
  tiled_until_ = begin + load_;
  passages_[n].loaded = begin;
  ++loaded_;

  sampled_.clear();
  source_.sample(passages_[n].triangle, sampled_);
  next_pixel_ = 0;
  tiling_ = true;
  return true;
}

// As far as there is room in the output FIFO; true if the triangle is done.
bool TilerPipeline::tile() {
  if (!tiling_) return false;
  const auto spend = [this](std::int32_t samples) {
    statistics_.samples += samples;
    statistics_.tiling.busy += samples * sample_;
    tiled_until_ += samples * sample_;
  };
  for (; next_pixel_ < sampled_.pixels.size(); ++next_pixel_) {
    if (made_ - taken_ == timing_.output_fifo) return false;
    const SampledPixel& pixel = sampled_.pixels[next_pixel_];
    spend(pixel.samples);
    const std::size_t slot = slotOf(made_);
    const Picoseconds into = std::max(tiled_until_, left_[slot]);
    statistics_.tiling.blocked += into - tiled_until_;
    ready_[slot] = tiled_until_ = into;

    const PixelPacket& packet = pixel.packet;
    output_[slot] = {.word = memoryWord(packet.depth, packet.color),
                     .address = static_cast<std::uint32_t>(packet.i) * kScreenPixels + packet.j,
                     .sequence = static_cast<std::uint32_t>(++made_),
                     .memory = static_cast<std::uint8_t>(map_.memory(packet.i, packet.j)),
                     .tiler = static_cast<std::uint8_t>(number_),
                     .background = packet.background};
  }
  spend(sampled_.samples_after);
  tiling_ = false;
  return true;
}

TreePixel TilerPipeline::take(Picoseconds now) {
  assert(ready() <= now);
  while (arrived_ < made_ && ready_[slotOf(arrived_)] <= now) ++arrived_;
  statistics_.output_high_water =
      std::max(statistics_.output_high_water, static_cast<int>(arrived_ - taken_));
  const std::size_t slot = slotOf(taken_);
  const TreePixel pixel = output_[slot];
  left_[slot] = now;
  ++taken_;
  if (tile()) advance();
  return pixel;
}

TilerStatistics TilerPipeline::statistics(Picoseconds end) const {
  assert(finished() && end >= tiled_until_);
  TilerStatistics result = statistics_;
  result.pixels = taken_;
  result.transfer.starved += end - transfer_end_;
  result.set_up.starved += end - set_up_end_;
  result.tiling.starved += end - tiled_until_;
  return result;
}

}  // namespace deltaz::ars
