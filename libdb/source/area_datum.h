// The datum all grids of an area refer to, read back from its header. Pure function.
#pragma once

#include <optional>

#include "formats/area.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

// Geographic, degrees; nothing if no grid names it: then all are projected from other datums.
std::optional<ReferenceSystem> datumOf(const AreaHeader& area);

}  // namespace deltaz
