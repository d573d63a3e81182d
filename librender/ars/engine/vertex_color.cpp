#include "librender/ars/engine/vertex_color.h"

#include <algorithm>
#include <cmath>

#include "librender/scene/view_volume.h"

namespace deltaz::ars {

namespace {

// IEC 61966-2-1.
double displayed(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  return 255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055);
}

}  // namespace

std::array<double, kColors> displayedColor(const LinearColor& linear) {
  return {displayed(linear.red), displayed(linear.green), displayed(linear.blue)};
}

std::array<double, kColors> vertexColor(const Environment& environment, Surface surface,
                                        const Vector3& position, const LinearColor& lit) {
  // No ray meets what lies behind the eye; near it haze is nothing.
  if (position.x < kHither) return displayedColor(lit);
  const ViewTransform& view = environment.view;
  const Vector3 ray =
      view.ray(view.centre_j + position.y / position.x, view.centre_i + position.z / position.x);
  return displayedColor(seenColor(environment, ray, surface, position.x, lit));
}

}  // namespace deltaz::ars
