// Texels of a field at any level: samples at their centres where the field is no finer, means of the texels
// below where it is.
#pragma once

#include <span>

#include "libdb/build/color_field.h"
#include "libdb/build/color_plan.h"

namespace deltaz {

class ColorFilter {
 public:
  // All must outlive it.
  ColorFilter(const ColorField& field, const GridHeader& grid);

  // Row by row from the south-west. Texels that hold nothing of the grid repeat the nearest that does, so
  // that colours are unmixed up to its edge. Cost: a sample for each texel of the field's own fineness;
  // memory 100 kB a level on the way there.
  Status texels(const TexelBlock& block, std::span<CoveredColor> colors) const;

 private:
  Status chunk(const TexelBlock& block, std::span<CoveredColor> colors) const;

  const ColorField& field_;
  const GridHeader& grid_;
  int root_level_;
};

}  // namespace deltaz
