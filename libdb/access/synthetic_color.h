// Natural colours made from the terrain alone: forest, meadow, rock and snow by altitude, slope and snow
// line; water where the ground is level and at or below 0 m. A scene definition: the same for every engine.
// Thread-safety: pure functions.
#pragma once

#include "libdb/access/color.h"

namespace deltaz {

// Rough height of the summer snow line, metres: 4,800 at the equator, highest under the dry subtropics, 2,350
// in the Cascades and Alps, about 0 at the poles. Continuous; the same on both hemispheres.
double snowLine(double latitude_degrees);

struct SurfacePoint {
  double height = 0;     // metres
  double upness = 1;     // cosine of the slope: N . up
  double poleward = 0;   // N . (horizontal direction to the nearer pole): shaded slopes keep more snow
  double snow_line = 0;  // metres
};

// Reflectance, linear.
LinearColor naturalColor(const SurfacePoint& point);

}  // namespace deltaz
