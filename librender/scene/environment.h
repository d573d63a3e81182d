// Everything both engines take from the scene definitions for one frame, and the checks both make.
#pragma once

#include <string>

#include "librender/scene/atmosphere.h"
#include "librender/scene/illumination.h"
#include "librender/scene/render.h"
#include "librender/scene/sea.h"

namespace deltaz {

inline constexpr int kLargestPicture = 1 << 14;  // pixels a side: the guard band of the pretiler

struct Environment {
  ViewTransform view;
  Light light;
  Atmosphere atmosphere;
  Sea sea;
  const ColorMap* color_map = nullptr;  // nullptr: colours by rule alone
};

// The map RenderOptions::color_map asks for, nullptr for none. kUsage, with the names there are, if there is
// no such map.
Result<const ColorMap*> chooseColorMap(const Database& database, const std::string& name);

// kUsage for views that make no sense and for colour maps that are not there. The database must live as
// long.
Result<Environment> makeEnvironment(const Database& database, const RenderOptions& options);

// A picture of the frame's size with room for what the options ask for, all sky.
Picture makePicture(const RenderOptions& options);

// What is left at the eye of a colour at depth `u` along the ray.
LinearColor seenColor(const Environment& environment, const Vector3& ray, Surface surface, double u,
                      const LinearColor& color);

// Stores a finished pixel: the colour that is seen, what it is, and its depth (+infinity for sky).
void storeSeen(Surface surface, double u, const LinearColor& seen, std::size_t pixel, Picture& picture);

// The same of a colour before haze.
void storePixel(const Environment& environment, const Vector3& ray, Surface surface, double u,
                const LinearColor& color, std::size_t pixel, Picture& picture);

}  // namespace deltaz
