// Natural colours made from the terrain alone: forest, meadow, rock and snow by altitude, slope and snow
// line; water where the ground is level and at or below 0 m. A scene definition: the same for every engine.
// Thread-safety: pure functions.
#pragma once

#include <cstddef>

#include "libdb/access/color.h"
#include "libdb/access/vector3.h"

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

// The same of `count` points, of as many at a time as the processor takes, with the same bits. Each list may
// be read, and those of `colors` written, up to kVectorPadding entries beyond its last.
struct SurfacePointLists {
  const double *height = nullptr, *upness = nullptr, *poleward = nullptr, *snow_line = nullptr;
};
struct ColorLists {
  double *red = nullptr, *green = nullptr, *blue = nullptr;
};
void naturalColors(const SurfacePointLists& points, std::size_t count, const ColorLists& colors);

// The same country in winter: the snow line kWinterDrop lower, forest frosted above it, level water at 0 m
// frozen where the snow comes down to it.
inline constexpr double kWinterDrop = 2000;  // metres
LinearColor winterColor(const SurfacePoint& point);

// The point on a terrain of height `height` whose ellipsoid normal is `up` and whose surface normal is
// `normal`, both Earth-centred unit vectors, at a latitude in degrees.
SurfacePoint surfacePoint(double height, const Vector3& normal, const Vector3& up, double latitude_degrees);

}  // namespace deltaz
