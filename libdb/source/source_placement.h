// Where the posts of a source lie, from its georeferencing. Pure function.
#pragma once

#include <string>
#include <vector>

#include "libdb/source/elevation_source.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

// Rotation terms that move no post by more than this are what arithmetic left of zero.
inline constexpr double kNoRotation = 1e-6;  // cells
// A georeferencing rounded to few decimals may reach so far beyond a pole, or more than once round the Earth:
// the exact one within twice as much is then taken, with a warning.
inline constexpr double kRoundedGeoreferencing = 1e-3;  // cells

// Kind and axes of the header. kInvalid for georeferencing no grid has.
Status placeSource(const SourceDescription& source, const std::string& path, const ReferenceSystem& system,
                   GridHeader& header, std::vector<std::string>& warnings);

}  // namespace deltaz
