// Pictures and depth maps as files, encoded by OpenImageIO in memory: equal pixels give equal bytes, with no
// date in them. Errors: kInternal (the encoder failed).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "librender/scene/render.h"

namespace deltaz {

// PNG, 8 bits a channel, sRGB.
Result<std::vector<std::byte>> encodePng(const Picture& picture);

// TIFF, one channel of 32-bit floats: metres along the view axis, +infinity where there is sky. `description`
// goes into ImageDescription.
Result<std::vector<std::byte>> encodeDepthTiff(const Picture& picture, const std::string& description);

}  // namespace deltaz
