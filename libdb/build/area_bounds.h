// The bounds of a gaming area in degrees, over all its grids. Thread-safety: pure functions.
#pragma once

#include <span>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

// west in [-180, 180], east > west, may exceed 180.
struct DegreeBounds {
  double west = 0, south = 0, east = 0, north = 0;
};

// Of one grid: its outermost posts. On a projected grid those of its outline, all of it; a grid whose outline
// goes round a pole reaches to the pole and all around.
DegreeBounds boundsOf(const GridGeometry& geometry);

// Of several: the shortest range of longitudes that holds them all.
DegreeBounds boundsOf(std::span<const GridGeometry* const> grids);

}  // namespace deltaz
