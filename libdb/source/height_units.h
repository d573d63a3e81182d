// Units of elevations as sources spell them. Pure function.
#pragma once

#include <optional>
#include <string>

#include "formats/area.h"

namespace deltaz {

// Metres in one `unit`, exactly: metres, feet, US survey feet. None and empty text mean metres. Nothing if
// the unit is unknown.
std::optional<Rational> metresPerUnit(const std::string& unit);

}  // namespace deltaz
