#include "librender/raster/tile_bins.h"

#include <algorithm>

namespace deltaz {
namespace {

constexpr std::size_t kChunk = 32;              // triangles; 2 KB
constexpr std::size_t kChunksOfSlab = 512;      // 1 MB
constexpr std::uint32_t kCrossingBlock = 1024;  // numbers a writer takes at once

}  // namespace

void TileBins::Writer::Bin::close() {
  if (segments.empty() || next == nullptr) return;
  segments.back().count = static_cast<std::uint32_t>(next - segments.back().first);
}

RasterTriangle* TileBins::Writer::takeChunk() {
  const std::size_t slab = chunks_taken_ / kChunksOfSlab, chunk = chunks_taken_ % kChunksOfSlab;
  if (slab == slabs_.size())
    slabs_.push_back(std::make_unique_for_overwrite<RasterTriangle[]>(kChunk * kChunksOfSlab + kAskedAhead));
  ++chunks_taken_;
  return slabs_[slab].get() + chunk * kChunk;
}

void TileBins::Writer::open(Bin& bin) {
  bin.close();
  if (bin.next == bin.end) {
    bin.next = takeChunk();
    bin.end = bin.next + kChunk;
  }
  bin.item = item_;
  bin.segments.push_back({item_, bin.next, 0});
}

std::uint32_t TileBins::Writer::crossingNumber() {
  if (crossing_next_ == crossing_end_) {
    crossing_next_ = crossing_count_->fetch_add(kCrossingBlock, std::memory_order_relaxed);
    crossing_end_ = crossing_next_ + kCrossingBlock;
  }
  ++crossing_used_;
  return crossing_next_++;
}

void TileBins::Writer::addToSeveral(RasterTriangle& triangle, const TileRange& tiles) {
  triangle.crossing = 1 + crossingNumber();
  copyTo(triangle, tiles);
}

void TileBins::Writer::copyTo(const RasterTriangle& triangle, const TileRange& tiles) {
  for (std::int32_t i = tiles.first_i; i <= tiles.last_i; ++i) {
    for (std::int32_t j = tiles.first_j; j <= tiles.last_j; ++j) *next(bin(j, i)) = triangle;
  }
}

void TileBins::reset(int width, int height, std::size_t writers) {
  across_ = (width + kTileSide - 1) / kTileSide;
  down_ = (height + kTileSide - 1) / kTileSide;
  crossing_count_.store(0, std::memory_order_relaxed);
  while (writers_.size() < writers) writers_.push_back(std::make_unique<Writer>());
  for (const std::unique_ptr<Writer>& writer : writers_) {
    writer->across_ = across_;
    writer->chunks_taken_ = 0;
    writer->crossing_next_ = writer->crossing_end_ = writer->crossing_used_ = 0;
    writer->crossing_count_ = &crossing_count_;
    writer->bins_.resize(tileCount());
    for (Writer::Bin& bin : writer->bins_) {
      bin.next = bin.end = nullptr;
      bin.item = 0xFFFFFFFF;
      bin.segments.clear();
    }
  }
}

void TileBins::finish() {
  for (const std::unique_ptr<Writer>& writer : writers_) {
    for (Writer::Bin& bin : writer->bins_) bin.close();
  }
}

std::uint64_t TileBins::crossingTriangles() const {
  std::uint64_t sum = 0;
  for (const std::unique_ptr<Writer>& writer : writers_) sum += writer->crossing_used_;
  return sum;
}

void TileBins::segmentsOf(std::size_t tile, std::vector<Segment>& segments) const {
  segments.clear();
  const auto earlier = [](const Segment& a, const Segment& b) { return a.item < b.item; };
  for (const std::unique_ptr<Writer>& writer : writers_) {
    const std::vector<Segment>& own = writer->bins_[tile].segments;
    const auto middle = segments.insert(segments.end(), own.begin(), own.end());
    // An item is one writer's, so that the order of its own runs is all there is to keep. Mostly a writer
    // takes items as they come.
    if (!std::is_sorted(middle, segments.end(), earlier)) std::stable_sort(middle, segments.end(), earlier);
    std::inplace_merge(segments.begin(), middle, segments.end(), earlier);
  }
}

}  // namespace deltaz
