// Joins rasters whose posts lie on one lattice into one grid. Pure function; memory: the joined grid and what
// it is made from.
#pragma once

#include <string>
#include <vector>

#include "libdb/source/source_raster.h"

namespace deltaz {

// Rasters of one reference system, spacing and phase that touch or overlap become one, in the place of the
// first of them; posts they share are there once. Where they overlap the earlier one wins, and a void never
// wins over a height. Differences between heights at shared posts are counted in `warnings`. Posts of the
// bounding rectangle that no raster covers are void. Errors: kInvalid (a joined grid too large).
Result<std::vector<SourceRaster>> joinRasters(std::vector<SourceRaster> rasters,
                                              std::vector<std::string>& warnings);

}  // namespace deltaz
