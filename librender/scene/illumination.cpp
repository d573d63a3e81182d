#include "librender/scene/illumination.h"

#include <GeographicLib/Math.hpp>

namespace deltaz {

Light makeLight(const AreaHeader& area, const Sun& sun) {
  Camera towards_sun;
  towards_sun.eye = {(area.south + area.north) / 2,
                     GeographicLib::Math::AngNormalize((area.west + area.east) / 2), 0};
  towards_sun.heading = sun.azimuth;
  towards_sun.pitch = sun.elevation;
  const EllipsoidShape ellipsoid = area.grids.empty() ? EllipsoidShape{} : area.grids.front().ellipsoid;
  Light light;
  light.to_sun = makeViewTransform(towards_sun, ellipsoid).forward;
  return light;
}

}  // namespace deltaz
