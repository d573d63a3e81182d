// The judge's own way through a colour map: texture coordinates from the ray through the pixel and the face
// it meets, and trilinear interpolation written out, tile by tile as they are asked for. What is computed is
// defined by raster/texture_sampler.h; nothing of its code is used.
//
// Thread-safety: one thread per object.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "libdb/access/color.h"
#include "libdb/access/color_map.h"
#include "libdb/access/vector3.h"
#include "librender/objects/terrain_object_processor.h"

namespace deltaz {

// What a pixel sees of a grid: where, and how many level-0 cells to the next pixel, the larger of both ways.
struct ReferenceFootprint {
  GridCoordinates place;
  double pixel_size = 0;
};

// `ray` is (1, j - centre_j, i - centre_i); vertices in view space, with their places in the grid.
ReferenceFootprint referenceFootprint(const std::array<Vector3, 3>& position,
                                      const std::array<GridCoordinates, 3>& texture, const Vector3& ray);

class ReferenceTexture {
 public:
  // `map` may be nullptr: no colours but `by_rule`.
  explicit ReferenceTexture(const ColorMap* map) : map_(map) {}

  // The colour of terrain that has `by_rule` without a map; both are lit. Errors: whatever reading reports.
  Result<LinearColor> shade(const LinearColor& by_rule, double intensity, std::uint16_t grid,
                            const ReferenceFootprint& footprint);
  std::size_t tilesRead() const { return tiles_.size(); }

 private:
  // Red, green and blue times cover, and cover; all linear, 0 .. 1.
  using Texel = std::array<double, 4>;
  Result<Texel> bilinear(std::uint16_t grid, const GridCoordinates& place, int level);

  const ColorMap* map_;
  std::map<std::uint32_t, std::vector<std::uint8_t>> tiles_;  // by block
};

}  // namespace deltaz
