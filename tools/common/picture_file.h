// Pictures and depth maps as files, encoded by OpenImageIO in memory: equal pixels give equal bytes, with no
// date in them. Errors: kInternal (the encoder failed); of reading: kCannotAccess, kInvalid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "librender/scene/render.h"

namespace deltaz {

// PNG, 8 bits a channel, sRGB.
Result<std::vector<std::byte>> encodePng(const Picture& picture);

// TIFF, one channel of 32-bit floats: metres along the view axis, +infinity where there is sky. `description`
// goes into ImageDescription.
Result<std::vector<std::byte>> encodeDepthTiff(const Picture& picture, const std::string& description);

// Colours of a picture file: 3 bytes a pixel, row by row from the top.
struct PictureColors {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};
// Any kind that OpenImageIO knows; of 8 bits a channel, red, green and blue.
Result<PictureColors> readPicture(const std::string& path);

}  // namespace deltaz
