#include "librender/raster/tiler.h"

#include <algorithm>
#include <cstddef>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace deltaz {
namespace {

// What a worker needs for a tile, kept from tile to tile.
struct Scratch {
  TileBuffer buffer;
  TileCounts counts;
  std::vector<TileBins::Segment> segments;
  std::vector<const RasterTriangle*> triangles;
  std::vector<std::uint32_t> slot;  // of a triangle among the faces that are seen
};

}  // namespace

SettledTile::Seen SettledTile::at(int j, int i) const {
  if (owner_.empty()) return {};
  const std::uint32_t owner = owner_[tileIndex(j, i)];
  if (owner == kNoTriangle) return {};
  return {&faces_[owner].planes, faces_[owner].grid};
}

class Tiler {
 public:
  Tiler(const TileBins& bins, const std::vector<PretiledNode>& nodes, const ViewTransform& view,
        const SampleOffsets* offsets)
      : bins_(bins), nodes_(nodes), view_(view), offsets_(offsets), crossing_(bins.crossingCount(), 0) {}

  TiledFrame run() {
    TiledFrame frame;
    frame.width = view_.width;
    frame.height = view_.height;
    frame.across = bins_.tilesAcross();
    frame.tiles.resize(bins_.tileCount());
    tbb::enumerable_thread_specific<std::unique_ptr<Scratch>> scratches(
        [] { return std::make_unique<Scratch>(); });
    tbb::parallel_for(std::size_t{0}, frame.tiles.size(),
                      [&](std::size_t t) { settle(t, *scratches.local(), frame.tiles[t]); });
    for (const std::unique_ptr<Scratch>& scratch : scratches) {
      frame.statistics.tested += scratch->counts.tested;
      frame.statistics.written += scratch->counts.written;
      frame.statistics.faces_drawn += scratch->counts.drawn;
      frame.statistics.hidden += scratch->counts.hidden;
      frame.statistics.no_sample += scratch->counts.no_sample;
    }
    std::uint64_t covers = 0, hidden = 0;
    for (const std::uint8_t bits : crossing_) {
      covers += (bits & kCrossingCovers) != 0 ? 1 : 0;
      hidden += bits == kCrossingHidden ? 1 : 0;
    }
    frame.statistics.faces_drawn += covers + hidden;
    frame.statistics.hidden += hidden;
    frame.statistics.no_sample += bins_.crossingTriangles() - covers - hidden;
    return frame;
  }

 private:
  void settle(std::size_t t, Scratch& scratch, SettledTile& tile) {
    bins_.segmentsOf(t, scratch.segments);
    scratch.triangles.clear();
    for (const TileBins::Segment& segment : scratch.segments) {
      for (std::uint32_t n = 0; n < segment.count; ++n) scratch.triangles.push_back(segment.first + n);
    }
    if (scratch.triangles.empty()) return;
    scratch.buffer.clear();
    const auto across = static_cast<std::size_t>(bins_.tilesAcross());
    rasterizeTile(
        {static_cast<int>(t % across), static_cast<int>(t / across), view_.width, view_.height, offsets_},
        scratch.triangles, crossing_, scratch.buffer, scratch.counts);

    // Planes are made when a face is first met.
    scratch.slot.assign(scratch.triangles.size(), kNoTriangle);
    tile.owner_.assign(scratch.buffer.inverse_u.size(), kNoTriangle);
    for (std::size_t pixel = 0; pixel < tile.owner_.size(); ++pixel) {
      if (scratch.buffer.inverse_u[pixel] == 0) continue;
      const std::uint32_t whole = scratch.buffer.whole[pixel / kBlockPixels];
      const std::uint32_t owner = whole != kNoTriangle ? whole : scratch.buffer.triangle[pixel];
      std::uint32_t& slot = scratch.slot[owner];
      if (slot == kNoTriangle) {
        slot = static_cast<std::uint32_t>(tile.faces_.size());
        const RasterTriangle& triangle = *scratch.triangles[owner];
        const PretiledNode& node = nodes_[triangle.node];
        tile.faces_.push_back({facePlanes(view_, node, triangle.face), node.grid});
      }
      tile.owner_[pixel] = slot;
    }
  }

  const TileBins& bins_;
  const std::vector<PretiledNode>& nodes_;
  const ViewTransform& view_;
  const SampleOffsets* offsets_;
  std::vector<std::uint8_t> crossing_;
};

TiledFrame tile(const TileBins& bins, const std::vector<PretiledNode>& nodes, const ViewTransform& view,
                const SampleOffsets* offsets) {
  return Tiler(bins, nodes, view, offsets).run();
}

}  // namespace deltaz
