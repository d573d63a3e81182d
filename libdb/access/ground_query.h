// Asks a database how high the ground is at a place.
// Thread-safety: pure functions.
#pragma once

#include <optional>

#include "libdb/access/database.h"

namespace deltaz {

// Height in metres above the database's datum of the full-resolution surface at a position in degrees: where
// the line along the ellipsoid normal meets the facet over that position (SW-NE diagonal), so that the chord
// of a coarse cell counts. Longitude may be given plus or minus a full turn. Nothing where no facet is:
// outside the area or at a void.
//
// Where grids overlap the first one with ground wins. Reads one page per level and one leaf.
// Errors: whatever reading the database reports.
Result<std::optional<double>> groundHeight(const Database& database, double latitude, double longitude);

}  // namespace deltaz
