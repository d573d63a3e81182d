// Colours the pixels of a settled tile by the colours at the corners of what is seen, interpolated in
// perspective: the plain shading of meshes whose RasterVertex::payload is an RGBA colour, a byte each, red
// lowest.
//
// Only what is seen is coloured, each pixel once. Weights are
// kept within the triangle, as the depth is. Same bits on every vector width. Thread-safety: different tiles
// from different threads.
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

// What shading needs of a triangle: its first vertex (x, y); the gradients of the weights of the second and
// of the third vertex, each times 1/U, planes through 0 at the first vertex; the colour of the first vertex,
// 0 to 255, and what each of the others adds to it.
struct alignas(64) ShadingPlanes {
  float value[16];
};

// Scratch of one worker, kept from tile to tile.
struct GouraudScratch {
  std::vector<ShadingPlanes> planes;  // of the tile's triangles
};

void shadeTileGouraud(const Tile& tile, std::span<const RasterTriangle* const> triangles,
                      const TileBuffer& buffer, GouraudScratch& scratch, ColorFrame& frame);

}  // namespace deltaz
