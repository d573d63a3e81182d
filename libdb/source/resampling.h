// One new grid from the surfaces of others: bilinear between the four posts around each exact position, the
// first raster that has a surface there. What that costs in accuracy is measured at the rasters' own posts.
// Pure function; memory: the new grid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "libdb/source/source_raster.h"

namespace deltaz {

// A resampled grid keeps centimetres, or its finest source's quantum if that is smaller.
inline constexpr Rational kResampledQuantum{1, 100};  // metres
inline constexpr double kResampledVoid = -32768;      // what an export writes at its voids

struct ResamplingTarget {
  ReferenceSystem system;              // geographic: a geodetic grid
  std::optional<PostSpacing> spacing;  // none: like that of the first raster
  std::optional<SourceBounds> bounds;
  std::optional<Rational> quantum;
  bool fill_voids = false;
  bool allow_ballpark = false;
};

struct ResampledRasters {
  SourceRaster raster;
  std::uint64_t filled_posts = 0;
};

// Pre: rasters are not empty, the finest first. Posts lie at whole multiples of the spacing. The header's
// `resampling` says how far the new surface, filled posts included, lies from the rasters' posts. kUsage if
// the spacing's unit does not go with the system, or no post of the new grid has a height.
Result<ResampledRasters> resampleRasters(std::span<const SourceRaster> rasters, const ReferenceSystem& area,
                                         const ResamplingTarget& target);

}  // namespace deltaz
