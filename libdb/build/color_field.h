// What gives every place of a grid its colour: images, a ramp over the heights, rules. A colour map is made
// of a field by libdb/build/color_pyramid.h.
//
// Thread-safety: implementations are called from several threads at once.
#pragma once

#include <cstdint>
#include <span>

#include "formats/error.h"
#include "libdb/access/color.h"

namespace deltaz {

// A rectangle of texels of one level over a grid. Texel (i, j) has its centre at i + 0.5, j + 0.5 times the
// side of a texel, in level-0 posts of the grid (colorTexelCells of libdb/access/color_map.h).
struct TexelBlock {
  std::uint16_t grid = 0;
  int level = 0;
  std::int64_t first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

class ColorField {
 public:
  virtual ~ColorField() = default;
  // Whether there may be any cover in the block.
  virtual bool touches(const TexelBlock& block) const = 0;
  // Whether the field shows more, somewhere in the block, than texels of level `level` can.
  virtual bool isFiner(const TexelBlock& block, int level) const = 0;
  // The field at the centres of the texels, row by row from the south-west.
  virtual Status sample(const TexelBlock& block, std::span<CoveredColor> colors) const = 0;
};

}  // namespace deltaz
