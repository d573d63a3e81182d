// Depth maps as TIFF files, by libtiff: equal depths give equal bytes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "librender/scene/render.h"

namespace deltaz {

// One channel of 32-bit floats, deflated, made in memory: metres along the view axis, +infinity where there
// is sky. `description` goes into ImageDescription. Errors: kInternal (the encoder failed).
Result<std::vector<std::byte>> encodeDepthTiff(const Picture& picture, const std::string& description);

}  // namespace deltaz
