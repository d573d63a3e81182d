// What the stages of triangle set-up hand to each other: arrays of a few triangles, one entry each. For the
// tile rasteriser alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "librender/raster/raster_triangle.h"
#include "librender/raster/tile_rasterizer.h"

namespace deltaz {

// Triangles that are set up together.
inline constexpr std::size_t kSetUpBatch = 16;
// Vectors of up to 16 are stored behind the last entry.
inline constexpr std::size_t kSetUpRoom = 3 * kSetUpBatch;

// Triangles that may show in the tile.
struct alignas(64) PlacedTriangles {
  float x[3][kSetUpRoom], y[3][kSetUpRoom], inverse_u[3][kSetUpRoom];
  // Snapped, from the tile's first pixel.
  std::int32_t snapped_x[3][kSetUpRoom], snapped_y[3][kSetUpRoom];
  // Blocks of the tile that the bounding box touches, first_j | first_i << 8 | last_j << 16 | last_i << 24.
  std::uint32_t blocks[kSetUpRoom];
  std::uint32_t number[kSetUpRoom];    // among the tile's triangles
  std::uint32_t crossing[kSetUpRoom];  // RasterTriangle::crossing
  std::size_t count;
};

// Edge functions are per_j * j + per_i * i + constant >= 0 for the samples inside.
struct alignas(64) SetUpTriangles {
  std::int32_t per_j[3][kSetUpBatch], per_i[3][kSetUpBatch];
  std::int32_t at_first_block[3][kSetUpBatch];  // constant at the first pixel of the first block
  // 256ths of the constants that rounding took, if samples are moved.
  std::int32_t remainder[3][kSetUpBatch];
  std::int32_t greatest_in_first_block[3][kSetUpBatch];
  std::uint32_t blocks[kSetUpBatch], number[kSetUpBatch];
  // 1/U at the first pixel of the first block, its gradient, and its range.
  float at_first[kSetUpBatch], gradient_x[kSetUpBatch], gradient_y[kSetUpBatch];
  float least[kSetUpBatch], greatest[kSetUpBatch];
};

// Edge functions of triangles in the guard band change by less than this from one pixel of a tile to any
// other, or to the fourth block behind the last: where they start beyond it only their sign counts, and sums
// stay in 32 bits.
inline constexpr double kSaturation = 1 << 30;
static_assert(2 * 2.0 * kGuardBand * kSubPixels * (kTileSide + 4 * kBlockSide) < kSaturation);
// Samples are moved by at most half a pixel.
static_assert(2 * 2.0 * kGuardBand * kSubPixels * (kSubPixels / 2) < 2 * kSaturation);

}  // namespace deltaz
