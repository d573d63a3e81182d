// Colours the pixels of a settled tile by the colours at the corners of what is seen, interpolated in
// perspective: the plain shading of meshes whose RasterVertex::payload is an RGBA colour, a byte each, red
// lowest.
//
// Only what is seen is coloured, each pixel once. A channel times 1/U is a plane on the screen, set up in
// double and evaluated in single precision; divided by the pixel's 1/U it stays within the range of the
// triangle's corners, as the depth does. Same bits on every vector width. Thread-safety: different tiles from
// different threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "librender/raster/line_allocator.h"
#include "librender/raster/tile_rasterizer.h"

namespace deltaz {

// Rows from the top.
struct ColorFrame {
  int width = 0, height = 0;
  std::uint32_t background = 0xFF000000;
  std::vector<std::uint32_t, LineAllocator<std::uint32_t>> rgba;
  std::vector<float, LineAllocator<float>> inverse_u;  // 0 where nothing is seen

  void resize(int new_width, int new_height);
};

// What shading needs of a triangle: of red, green and blue, 0 to 255, each times 1/U, the change a pixel to
// the right, the change a pixel down and the value at the tile's first pixel; then the bits of the least and
// of the greatest colour of its corners, channel by channel, opaque. Twelve values are used.
struct alignas(64) ShadingPlanes {
  float value[16];
};

// Scratch of one worker, kept from tile to tile.
struct GouraudScratch {
  std::vector<ShadingPlanes> planes;  // of the tile's triangles
};

// Leaves `buffer` clear, for the next tile: that costs next to nothing here. Pixels may be stored past the
// caches: hwy::FlushStream() comes before another thread reads them.
void shadeTileGouraud(const Tile& tile, std::span<const RasterTriangle* const> triangles, TileBuffer& buffer,
                      GouraudScratch& scratch, ColorFrame& frame);

}  // namespace deltaz
