// Grids of posts in UTM made from a seed, with the control points that place them, through GeographicLib and
// no code of ours.
#pragma once

#include <cstdint>

#include "tests/support/synthetic_grid.h"

namespace deltaz {

struct ProjectedGridOptions {
  int zone = 17;            // northern hemisphere
  double easting = 500000;  // of the south-west post, metres; rounded down to a multiple of the spacing
  double northing = 4800000;
  std::int64_t spacing = 30;  // metres
  std::int64_t columns = 121, rows = 121;
  std::int64_t patch_cells = 64;  // a power of two
  VoidPattern voids = VoidPattern::kNone;
  std::uint32_t seed = 1;
};

RawGrid projectedGrid(const ProjectedGridOptions& options = {});

}  // namespace deltaz
