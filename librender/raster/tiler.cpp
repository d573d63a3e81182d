#include "librender/raster/tiler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace deltaz {

namespace {

// The least 1/U of the blocks that hold an inclusive range of a tile's pixels; if one is less than `enough`,
// the others may go unlooked at.
float leastWithin(const TileBuffer& buffer, int first_j, int last_j, int first_i, int last_i, float enough) {
  float least = HUGE_VALF;
  for (int i = first_i / kBlockSide; i <= last_i / kBlockSide && least >= enough; ++i) {
    for (int j = first_j / kBlockSide; j <= last_j / kBlockSide; ++j)
      least = std::min(least, buffer.least[static_cast<std::size_t>(i * kBlocksAcross + j)]);
  }
  return least;
}

}  // namespace

void Tiler::begin(int width, int height, const SampleOffsets* offsets) {
  offsets_ = offsets;
  frame_.width = width;
  frame_.height = height;
  frame_.across = (width + kTileSide - 1) / kTileSide;
  const int down = (height + kTileSide - 1) / kTileSide;
  frame_.statistics = crossing_counts_ = {};
  frame_.tiles.resize(static_cast<std::size_t>(frame_.across) * static_cast<std::size_t>(down));
  open_.resize(frame_.tiles.size());
  for (const std::unique_ptr<OpenTile>& tile : open_) {
    if (tile) tile->triangles.clear();
  }
  workers_.resize(
      std::max(workers_.size(), static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())));
  for (Worker& worker : workers_) worker.counts = {};
}

std::size_t Tiler::workerNumber() {
  return static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
}

void Tiler::draw(const TileBins& bins) {
  crossing_.reset(workers_.size(), 1 + bins.crossingCount());
  tbb::parallel_for(std::size_t{0}, open_.size(), [&](std::size_t t) { drawTile(bins, t); });
  const CrossingFates::Counts crossing = crossing_.counted();
  crossing_counts_.faces_drawn += crossing.covering + crossing.hidden;
  crossing_counts_.hidden += crossing.hidden;
  crossing_counts_.no_sample += bins.crossingTriangles() - crossing.covering - crossing.hidden;
}

void Tiler::drawTile(const TileBins& bins, std::size_t t) {
  Worker& worker = workers_[workerNumber()];
  bins.segmentsOf(t, worker.segments);
  if (worker.segments.empty()) return;
  if (!open_[t]) open_[t] = std::make_unique<OpenTile>();
  OpenTile& open = *open_[t];
  const std::size_t before = open.triangles.size();
  for (const TileBins::Segment& segment : worker.segments) {
    for (std::uint32_t n = 0; n < segment.count; ++n) open.triangles.push_back(segment.first + n);
  }
  if (before == 0) open.buffer.clear();
  const auto across = static_cast<std::size_t>(frame_.across);
  const Tile tile{static_cast<int>(t % across), static_cast<int>(t / across), frame_.width, frame_.height,
                  offsets_};
  rasterizeTile(tile, open.triangles, before, crossing_.notesOf(workerNumber()), open.buffer, worker.counts);
  open.least = leastWithin(open.buffer, 0, std::min(kTileSide, tile.width - tile.j * kTileSide) - 1, 0,
                           std::min(kTileSide, tile.height - tile.i * kTileSide) - 1, 0);
}

bool Tiler::isHidden(const ScreenExtent& extent) const {
  if (extent.empty()) return false;
  // Samples that show nothing have 1/U = 0.
  const float nearest = std::nextafter(static_cast<float>(extent.largest_inverse_u), HUGE_VALF);
  for (int i = extent.first_i / kTileSide; i <= extent.last_i / kTileSide; ++i) {
    for (int j = extent.first_j / kTileSide; j <= extent.last_j / kTileSide; ++j) {
      const OpenTile* const open =
          open_[static_cast<std::size_t>(i) * static_cast<std::size_t>(frame_.across) +
                static_cast<std::size_t>(j)]
              .get();
      if (open == nullptr || open->triangles.empty()) return false;
      if (open->least >= nearest) continue;
      const int j0 = j * kTileSide, i0 = i * kTileSide;
      if (leastWithin(open->buffer, std::max(0, extent.first_j - j0),
                      std::min(kTileSide - 1, extent.last_j - j0), std::max(0, extent.first_i - i0),
                      std::min(kTileSide - 1, extent.last_i - i0), nearest) < nearest)
        return false;
    }
  }
  return true;
}

const TiledFrame& Tiler::settle() {
  tbb::parallel_for(std::size_t{0}, open_.size(), [&](std::size_t t) {
    frame_.tiles[t].faces_.clear();
    frame_.tiles[t].owner_.clear();
    if (open_[t] && !open_[t]->triangles.empty())
      settleTile(*open_[t], workers_[workerNumber()], frame_.tiles[t]);
  });
  frame_.statistics = crossing_counts_;
  for (const Worker& worker : workers_) {
    frame_.statistics.tested += worker.counts.tested;
    frame_.statistics.written += worker.counts.written;
    frame_.statistics.faces_drawn += worker.counts.drawn;
    frame_.statistics.hidden += worker.counts.hidden;
    frame_.statistics.no_sample += worker.counts.no_sample;
  }
  return frame_;
}

void Tiler::settleTile(const OpenTile& open, Worker& worker, SettledTile& tile) {
  const TileBuffer& buffer = open.buffer;
  // Faces are named in the order in which they are met.
  worker.slot.assign(open.triangles.size(), kNoTriangle);
  tile.owner_.assign(buffer.inverse_u.size(), kNoTriangle);
  for (std::size_t pixel = 0; pixel < tile.owner_.size(); ++pixel) {
    const std::uint32_t owner = buffer.triangle[pixel];
    if (owner == kNoTriangle) continue;
    std::uint32_t& slot = worker.slot[owner];
    if (slot == kNoTriangle) {
      slot = static_cast<std::uint32_t>(tile.faces_.size());
      const RasterTriangle& triangle = *open.triangles[owner];
      tile.faces_.push_back({triangle.node, triangle.face});
    }
    tile.owner_[pixel] = slot;
  }
}

}  // namespace deltaz
