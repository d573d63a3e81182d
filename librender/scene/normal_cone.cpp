#include "librender/scene/normal_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace deltaz {

bool facesAway(const Node& node, const Vector3& eye) {
  // Radians for what rounding does to normals and positions.
  constexpr double kSlack = 1e-4;
  const auto& packed = node.record.mean_normal;
  const Vector3 axis{static_cast<double>(packed[0]), static_cast<double>(packed[1]),
                     static_cast<double>(packed[2])};
  const double size = length(axis);
  // No facet, no cone.
  if (!(size > 0)) return false;
  const Vector3 offset = node.centroid - eye;
  const double distance = length(offset);
  if (distance <= node.radius()) return false;
  // The angle the offset may still have to the axis: cos(angle + cone) >= radius / distance.
  const double cone = node.record.cone_half_angle * (std::numbers::pi / 65535.0) + kSlack;
  const double most = std::acos(node.radius() / distance) - cone;
  return most > 0 && dot(axis, offset) >= std::cos(most) * size * distance;
}

}  // namespace deltaz
