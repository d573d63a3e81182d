// Colours as the machine's frame memory holds them: what is shown, 0 to 255, a fraction between codes.
// Thread-safety: pure functions.
#pragma once

#include <array>

#include "libdb/access/color.h"
#include "librender/ars/pretiler/screen_triangle.h"
#include "librender/scene/environment.h"

namespace deltaz::ars {

// The sRGB curve without rounding; values outside 0 to 1 are clamped.
std::array<double, kColors> displayedColor(const LinearColor& linear);

// Of a lit vertex, seen from the eye through the haze.
std::array<double, kColors> vertexColor(const Environment& environment, Surface surface,
                                        const Vector3& position, const LinearColor& lit);

}  // namespace deltaz::ars
