// The tiler (report 4.2): binned triangles -> for every pixel the nearest of them, tile by tile.
//
// A frame is drawn in batches, front to back. What is there after one tells which nodes of the next cannot be
// seen (isHidden), so that they need not be read.
//
// Tiles are drawn on the threads of the caller's TBB arena; the result does not depend on them, nor do the
// counts. Memory is kept from frame to frame. Thread-safety: one frame at a time; isHidden from any thread
// between calls of the others.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "librender/raster/crossing_fates.h"
#include "librender/raster/face_lanes.h"
#include "librender/raster/tile_bins.h"
#include "librender/raster/tile_rasterizer.h"
#include "librender/scene/screen_extent.h"

namespace deltaz {

// A tile whose visibility is settled.
class SettledTile {
 public:
  // What is seen at pixel (j, i) of the tile, counted from its first: index into faces, or kNoTriangle.
  std::uint32_t at(int j, int i) const { return owner_.empty() ? kNoTriangle : owner_[tileIndex(j, i)]; }
  // The same of all pixels, in the order of TileBuffer; empty if nothing is seen.
  const std::vector<std::uint32_t>& owners() const { return owner_; }
  // The faces that are seen.
  const std::vector<SeenFace>& faces() const { return faces_; }

 private:
  friend class Tiler;
  std::vector<SeenFace> faces_;
  std::vector<std::uint32_t> owner_;  // of each pixel, in the order of TileBuffer; empty if nothing is seen
};

struct TilerStatistics {
  std::uint64_t tested = 0, written = 0;  // samples
  std::uint64_t faces_drawn = 0,
                no_sample = 0;  // faces that reached the depth test, and that cover no sample after all
  std::uint64_t hidden = 0;     // of those drawn: behind all that was there before any sample was looked at
};

struct TiledFrame {
  int width = 0, height = 0, across = 0;  // pixels, pixels, tiles
  std::vector<SettledTile> tiles;         // row by row
  TilerStatistics statistics;
};

// A tile that is being drawn.
struct OpenTile {
  TileBuffer buffer;                             // once there are triangles
  std::vector<const RasterTriangle*> triangles;  // so far; owners in `buffer` are their indices
  float least = 0;                               // 1/U of its samples is no less
};

class Tiler {
 public:
  // Begins a frame: nothing is seen yet. `offsets`: as of Tile.
  void begin(int width, int height, const SampleOffsets* offsets = nullptr);
  // Draws what lies in the bins, which must stay as they are until the frame is settled.
  void draw(const TileBins& bins);
  // True only if all samples within the extent show something already, none with a lesser 1/U than the
  // extent's largest: what lies in it changes nothing. Never of an empty one.
  bool isHidden(const ScreenExtent& extent) const;
  // Valid until the next frame.
  const TiledFrame& settle();

 private:
  // What a worker needs for a tile.
  struct alignas(64) Worker {
    TileCounts counts;
    std::vector<TileBins::Segment> segments;
    std::vector<std::uint32_t> slot;  // of a triangle among the faces that are seen
  };
  static std::size_t workerNumber();
  void drawTile(const TileBins& bins, std::size_t t);
  static void settleTile(const OpenTile& open, Worker& worker, SettledTile& tile);

  std::vector<std::unique_ptr<OpenTile>> open_;  // row by row; none where no frame drew anything yet
  std::vector<Worker> workers_;                  // by the thread's place in the arena
  CrossingFates crossing_;                       // of the batch
  TilerStatistics crossing_counts_;              // of the batches so far
  const SampleOffsets* offsets_ = nullptr;
  TiledFrame frame_;
};

}  // namespace deltaz
