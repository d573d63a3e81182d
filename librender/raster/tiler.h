// The tiler (report 4.2): binned triangles -> for every pixel the nearest of them, tile by tile, and the
// planes of the faces that are seen.
//
// Tiles are drawn on the threads of the caller's TBB arena; the result does not depend on them, nor do the
// counts.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "librender/raster/pretiler.h"
#include "librender/raster/tile_bins.h"
#include "librender/raster/tile_rasterizer.h"

namespace deltaz {

// A tile whose visibility is settled.
class SettledTile {
 public:
  // What is seen at a pixel of the tile.
  struct Seen {
    const FacePlanes* face = nullptr;  // nullptr: nothing
    std::uint16_t grid = 0;            // whose colours it shows
  };
  // Pixel (j, i) of the tile, counted from its first.
  Seen at(int j, int i) const;

 private:
  friend class Tiler;
  struct Face {
    FacePlanes planes;
    std::uint16_t grid = 0;
  };
  std::vector<Face> faces_;  // that are seen
  std::vector<std::uint32_t>
      owner_;  // of each pixel in faces_, in the order of TileBuffer; kNoTriangle for none; empty if none is
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

// `nodes` are those whose faces lie in the bins, by RasterTriangle::node. `offsets`: as of Tile.
TiledFrame tile(const TileBins& bins, const std::vector<PretiledNode>& nodes, const ViewTransform& view,
                const SampleOffsets* offsets = nullptr);

}  // namespace deltaz
