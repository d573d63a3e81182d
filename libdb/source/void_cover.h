// Which posts of a grid lie on facets of other grids: there a void of the one is no hole in the area.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libdb/source/grid_surface.h"

namespace deltaz {

// 1 for every void post, and every neighbour of one, that lies on a valid facet (as drawn: cells are cut from
// south-west to north-east) of another grid; empty if there is none. Void posts among them take the height of
// the first such grid, in quanta of `grid`, and stay void. Errors as CoordinateChange::between. Cost: a
// change of coordinates for every such post and grid.
Result<std::vector<std::uint8_t>> coverVoids(RawGrid& grid, const ReferenceSystem& system,
                                             std::span<const PlacedGrid> others, bool allow_ballpark);

}  // namespace deltaz
