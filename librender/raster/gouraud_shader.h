// Colours the pixels of a settled tile by the colours at the corners of what is seen, interpolated in
// perspective: the plain shading of meshes whose RasterVertex::payload is an RGBA colour, a byte each, red
// lowest.
//
// Only what is seen is coloured, each pixel once; set-up is made for triangles that are seen. Weights are
// kept within the triangle, as the depth is. Same bits on every vector width. Thread-safety: different tiles
// from different threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "librender/raster/tile_rasterizer.h"

namespace deltaz {

// Rows from the top.
struct ColorFrame {
  int width = 0, height = 0;
  std::uint32_t background = 0xFF000000;
  std::vector<std::uint32_t> rgba;
  std::vector<float> inverse_u;  // 0 where nothing is seen

  void resize(int new_width, int new_height);
};

// What shading needs of a triangle that is seen. The weights of the second and third vertex, each times 1/U,
// are planes through 0 at the first vertex.
struct ShadingPlanes {
  float anchor_x, anchor_y;
  float second_x, second_y, third_x, third_y;  // gradients
  float color[3];                              // of the first vertex, 0 to 255
  float to_second[3], to_third[3];             // what the others add
  float unused;
};
static_assert(sizeof(ShadingPlanes) == 64);

// Scratch of one worker, kept from tile to tile.
struct GouraudScratch {
  std::vector<std::uint32_t> slot;    // of a triangle of the tile in `planes`, or kNoTriangle
  std::vector<ShadingPlanes> planes;  // of those that are seen
};

void shadeTileGouraud(const Tile& tile, std::span<const RasterTriangle* const> triangles,
                      const TileBuffer& buffer, GouraudScratch& scratch, ColorFrame& frame);

}  // namespace deltaz
