// The country most drawing tests look at.
#pragma once

#include "tests/support/synthetic_grid.h"

namespace deltaz {

// Rough country near Rainier, 121 x 121 posts of 3 arc-seconds.
inline SyntheticGridOptions smallArea() {
  SyntheticGridOptions options;
  options.south = 46.8;
  options.west = -121.8;
  options.spacing_latitude = options.spacing_longitude = {3, 1};
  options.lowest = 500;
  options.highest = 3200;
  return options;
}

}  // namespace deltaz
