// Texels as they are stored, and the rule by which four of them make one of the level above: a definition of
// the format (formats/color_file.md). Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>

#include "libdb/build/color_field.h"

namespace deltaz {

// Red, green, blue (sRGB codes), cover (0 .. 255).
using Texel = std::array<std::uint8_t, 4>;

// Rounded to the nearest codes; a texel whose cover rounds to 0 is {0, 0, 0, 0}.
Texel storedTexel(const CoveredColor& color);

// The mean of four stored texels, in the order south-west, south-east, north-west, north-east: cover the mean
// of theirs, halves rounded up; colour the mean in linear light, each weighted with its cover.
Texel meanTexel(const Texel& sw, const Texel& se, const Texel& nw, const Texel& ne);

}  // namespace deltaz
