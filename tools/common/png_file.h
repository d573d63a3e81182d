// PNG pictures, by libpng: equal pixels give equal bytes, with no date in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "librender/scene/render.h"

namespace deltaz {

// 8 bits a channel, sRGB, made in memory. Errors: kInternal (the encoder failed).
Result<std::vector<std::byte>> encodePng(const Picture& picture);

// Colours of a picture file: 3 bytes a pixel, row by row from the top.
struct PictureColors {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// A PNG file of red, green and blue, 8 bits a channel. Errors: kCannotAccess; kInvalid (no PNG, another kind
// of pixels, larger than a picture may be, damaged).
Result<PictureColors> readPng(const std::string& path);

}  // namespace deltaz
