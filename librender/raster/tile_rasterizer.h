// Settles what is seen in one tile of 64 x 64 pixels: for each pixel the nearest 1/U and the triangle it
// belongs to.
//
// Coverage is exact: vertices snapped to 1/256 pixel, edge functions in integers, top-left rule (coverage.h
// says it in scalar code). 1/U is the triangle's plane in single precision, anchored at its first vertex, its
// gradients from double differences of the unsnapped vertices, kept within the range of the vertices.
// Strictly greater wins, so that of equals the first submitted stays.
//
// Pixels lie in blocks of 4 x 4, so that a block is one vector of 16 and one cache line. The least 1/U of
// every block is kept: blocks that a triangle lies behind are passed over (hierarchical z; Greene 1993),
// which changes no pixel. Which blocks a triangle may show in is found for 4 x 4 of them at once (after
// Abrash 2009); the blocks of a batch of triangles are then drawn in one loop. The bits are the same on every
// vector width. Thread-safety: different tiles from different threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "librender/antialias/sample_pattern.h"
#include "librender/raster/raster_triangle.h"
#include "librender/raster/tile_bins.h"

namespace deltaz {

inline constexpr int kBlockSide = 4;                          // pixels
inline constexpr int kBlocksAcross = kTileSide / kBlockSide;  // of a tile
inline constexpr int kBlockPixels = kBlockSide * kBlockSide;
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;

struct alignas(64) TileBuffer {
  // Block by block, rows of blocks from the top; within a block row by row.
  std::array<float, kTileSide * kTileSide> inverse_u;  // 0 where nothing is seen
  // Index into the tile's triangles of the one seen, or kNoTriangle.
  std::array<std::uint32_t, kTileSide * kTileSide> triangle;
  // Of a block's 1/U; never too great. Blocks below and right of the last may be asked about.
  std::array<float, kBlocksAcross * kBlocksAcross + 4 * kBlocksAcross> least;
  std::vector<std::uint8_t> wrote;  // 1: some sample was the triangle's, at least for a while; else 0

  void clear();
};

// Where in a TileBuffer a pixel of the tile lies.
inline std::size_t tileIndex(int j, int i) {
  return static_cast<std::size_t>(((i / kBlockSide) * kBlocksAcross + j / kBlockSide) * kBlockPixels +
                                  (i % kBlockSide) * kBlockSide + j % kBlockSide);
}

struct TileCounts {
  std::uint64_t tested = 0, written = 0;  // samples
  // Triangles that touch no other tile: those that cover a sample or lie behind all that is there, of these
  // the latter, and those that cover none.
  std::uint64_t drawn = 0, hidden = 0, no_sample = 0;
};

struct Tile {
  int j = 0, i = 0;           // in tiles
  int width = 0, height = 0;  // of the picture, pixels
  // How samples are moved from the pixels' centres; nullptr: they are the centres.
  const SampleOffsets* offsets = nullptr;
};

// Draws triangles[first] and those that follow; owners in `buffer` are indices into `triangles`. Adds to
// `counts`, and notes what becomes of triangles that touch several tiles in `crossing`, by
// RasterTriangle::crossing (crossing_fates.h).
void rasterizeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, std::size_t first,
                   std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts);

}  // namespace deltaz
