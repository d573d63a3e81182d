// Reference systems in which the Earth repeats itself to the east. Thread-safety: pure function.
#pragma once

#include "libdb/source/reference_system.h"

namespace deltaz {

// How far east, in the system's units, the same places come again: 360 for geographic systems, the length of
// the equator for cylindrical projections such as Mercator's; 0 where they never do.
double turnLength(const ReferenceSystem& system);

}  // namespace deltaz
