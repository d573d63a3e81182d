// Makes the control points that place a projected grid (formats/patch_lattice.h): the largest patches whose
// measured error is within the aim. Cost: proportional to the sampled positions, a few million at most.
#pragma once

#include <memory>
#include <string>

#include "formats/area.h"
#include "formats/error.h"
#include "formats/patch_lattice.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

// Interpolation error aimed at: a micrometre. Patches are made smaller down to one post a control point until
// it is met; failing that, kPatchErrorBound must hold.
inline constexpr double kPatchErrorAim = 1e-6;  // metres
// The measured error is multiplied by this, since the worst point may lie between the sampled ones.
inline constexpr double kPatchErrorMargin = 1.25;

// Axes of `header` in units of its own system; `to_geographic` leads from there to latitudes and longitudes
// of the header's ellipsoid. kInvalid if some post has no place on the Earth, or the bound cannot be met.
Result<std::shared_ptr<const PatchLattice>> fitPatches(const GridHeader& header,
                                                       const CoordinateChange& to_geographic,
                                                       const std::string& path);

}  // namespace deltaz
