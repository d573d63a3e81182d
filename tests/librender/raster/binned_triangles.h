// For tests: what a pretiler put into bins, tile by tile.
#pragma once

#include <utility>
#include <vector>

#include "librender/raster/coverage.h"
#include "librender/raster/tile_bins.h"

namespace deltaz {

inline SnappedTriangle snappedOf(const RasterTriangle& triangle, int width, int height) {
  SnappedTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.x[k] = snappedCoordinate(triangle.vertex[k].x, width);
    result.y[k] = snappedCoordinate(triangle.vertex[k].y, height);
  }
  return result;
}

// Calls visit(triangle, snapped, its pixels in this tile) for every triangle of every tile, in the order
// tiles take them.
template <typename Visit>
void forEachBinnedTriangle(const TileBins& bins, int width, int height, Visit&& visit) {
  std::vector<TileBins::Segment> segments;
  for (std::size_t t = 0; t < bins.tileCount(); ++t) {
    const auto across = static_cast<std::size_t>(bins.tilesAcross());
    const auto j = static_cast<std::int32_t>(t % across) * kTileSide,
               i = static_cast<std::int32_t>(t / across) * kTileSide;
    const SampleBounds pixels{j, j + kTileSide - 1, i, i + kTileSide - 1};
    bins.segmentsOf(t, segments);
    for (const TileBins::Segment& segment : segments) {
      for (std::uint32_t n = 0; n < segment.count; ++n) {
        const SnappedTriangle snapped = snappedOf(segment.first[n], width, height);
        visit(segment.first[n], snapped, intersection(sampleBounds(snapped, width, height), pixels));
      }
    }
  }
}

}  // namespace deltaz
