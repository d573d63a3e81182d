// A triangle on the screen, ready to be tiled, and the vertices it is made of.
//
// Positions are in pixels from the picture's centre, x along j and y along i, unsnapped and in single
// precision: what is lost is at most 2^-24 of a vertex's distance from the eye. Coverage uses them snapped to
// 1/256 pixel (snappedCoordinate), depth and attributes as they are. Thread-safety: plain values.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace deltaz {

inline constexpr int kSubPixelBits = 8;
inline constexpr int kSubPixels = 1 << kSubPixelBits;

// How far from the picture's centre positions may lie, pixels. Pictures are at most 16,384 pixels wide and
// high; edge functions of triangles in the guard band fit into 32 bits within a tile.
inline constexpr int kGuardBand = 9216;

// No member initialisers: they are made by the million, and written whole.
struct RasterVertex {
  float x, y;             // pixels from the picture's centre
  float inverse_u;        // 1 / metres
  std::uint32_t payload;  // the caller's
};

// Snapped coordinates are counted from the centre of pixel 0: the pixel centres lie at multiples of 256.
// Nearest, ties to even.
inline std::int32_t snappedCoordinate(float from_centre, int extent_pixels) {
  return static_cast<std::int32_t>(std::lrint(static_cast<double>(from_centre) * kSubPixels)) +
         (extent_pixels - 1) * (kSubPixels / 2);
}

// One cache line. Vertices run clockwise on the screen, y down.
struct alignas(64) RasterTriangle {
  RasterVertex vertex[3];
  std::uint32_t node, face;  // the caller's name for it
  std::uint32_t crossing;    // 0, or 1 + its number among those that touch several tiles
};
static_assert(sizeof(RasterTriangle) == 64);
static_assert(offsetof(RasterTriangle, node) == 48 && offsetof(RasterTriangle, crossing) == 56);

}  // namespace deltaz
