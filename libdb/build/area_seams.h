// The seams of an area: between every two grids whose coverages touch. Thread-safety: pure function.
#pragma once

#include <span>
#include <vector>

#include "formats/seam.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

// In the order of the grids, upper before lower. A grid whose edge lies altogether under a third one drawn
// between or above the two makes no seam there. kInvalid where three grids meet at one place, which a seam
// between two cannot join.
Result<std::vector<Seam>> makeSeams(std::span<const RawGrid> grids);

}  // namespace deltaz
