// What the vectors of a block of 4 x 4 pixels share: where its pixels lie from its first, and how steep a
// plane over them may be.
#pragma once

#include <cstdint>

#include "librender/raster/tile_rasterizer.h"

namespace deltaz {

alignas(64) inline constexpr std::int32_t kLaneJ[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                                  0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) inline constexpr std::int32_t kLaneI[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                                  2, 2, 2, 2, 3, 3, 3, 3};
// The same as floating-point numbers.
alignas(64) inline constexpr float kLaneX[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) inline constexpr float kLaneY[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

// Of a block among those of the tile, from the first of a neighbourhood of 4 x 4 blocks.
alignas(64) inline constexpr std::int32_t kNeighbour[kBlockPixels] = {0,  1,  2,  3,  16, 17, 18, 19,
                                                                      32, 33, 34, 35, 48, 49, 50, 51};

// Gradients of slivers that are lines but for rounding are limited; products with distances stay finite.
inline constexpr double kSteepest = 1e15;

}  // namespace deltaz
