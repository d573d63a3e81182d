// Images as the colours of a grid: bilinear in linear light, weighted with cover; of classes the nearest. The
// earlier image lies on top where they overlap.
//
// A texel's centre goes through PROJ from the grid's reference system to the image's; between positions that
// were computed so others are interpolated where that is off by less than kPlaceTolerance pixels, measured at
// five places of every rectangle. Errors: those of reading, and of CoordinateChange::between.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "formats/area.h"
#include "libdb/build/color_field.h"
#include "libdb/build/placed_image.h"

namespace deltaz {

inline constexpr double kPlaceTolerance = 1.0 / 64;  // pixels; what is promised is 1/16

class ImageField final : public ColorField {
 public:
  // Over the grid alone whose number is asked for. `images` and `grid` must outlive it.
  static Result<std::unique_ptr<ImageField>> make(const GridHeader& grid, std::span<const ColorImage> images,
                                                  bool allow_ballpark);

  bool touches(const TexelBlock& block) const override;
  bool isFiner(const TexelBlock& block, int level) const override;
  Status sample(const TexelBlock& block, std::span<CoveredColor> colors) const override;

 private:
  ImageField() = default;
  Status lay(const PlacedImage& placed, const TexelBlock& block, std::span<CoveredColor> colors) const;
  std::vector<std::unique_ptr<PlacedImage>> images_;
};

}  // namespace deltaz
