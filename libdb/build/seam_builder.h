// Makes the seam between two overlapping or touching grids: where the edge of the upper grid's coverage runs
// over the lower grid, both follow the lower grid's surface (formats/seam.h).
//
// The edge is that of the upper grid's valid faces, so the lower grid also shows through the upper one's
// voids. Its posts move onto the lower grid's facets, and it gets a point wherever it crosses a lower edge;
// lower faces it passes are cut along it (constrained Delaunay triangulation, Chew 1989, in the cell's own
// coordinates, where facets' edges are exact lines). Cost: a few microseconds a lower face and edge post.
// Errors: kInvalid if what the user gave cannot be joined. Thread-safety: pure function.
#pragma once

#include <optional>

#include "formats/seam.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

// Nothing if the grids do not touch. `upper` and `lower` are indices among the area's grids, for the seam.
Result<std::optional<Seam>> makeSeam(const RawGrid& upper_grid, std::uint16_t upper,
                                     const RawGrid& lower_grid, std::uint16_t lower);

}  // namespace deltaz
