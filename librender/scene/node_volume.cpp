#include "librender/scene/node_volume.h"

#include <algorithm>
#include <cmath>

namespace deltaz {
namespace {

// Metres by which what is drawn may lie beside the exact posts: the bound of the exact transform, ten times.
constexpr double kSlack = 0.01;

struct Ellipsoid {
  explicit Ellipsoid(const EllipsoidShape& shape)
      : a(shape.semi_major_axis),
        b(a * (shape.inverse_flattening != 0 ? 1 - 1 / shape.inverse_flattening : 1)),
        least_curvature_radius(std::min(a * a / b, b * b / a)) {}
  double a, b, least_curvature_radius;
};

}  // namespace

NodeVolume volumeOf(const Node& node, const GridGeometry& geometry, bool heights_hold) {
  const GridHeader& header = geometry.header();
  const Ellipsoid ellipsoid(header.ellipsoid);
  NodeVolume volume;
  volume.centre = node.centroid;
  volume.radius = node.radius();
  volume.low = -volume.radius;
  volume.high = volume.horizontal = volume.radius;
  const double squash = (ellipsoid.a * ellipsoid.a) / (ellipsoid.b * ellipsoid.b);
  const Vector3 normal{volume.centre.x, volume.centre.y, volume.centre.z * squash};
  volume.up = length(normal) > 0 ? normalized(normal) : Vector3{0, 0, 1};
  if (!heights_hold || !(length(normal) > 0)) return volume;

  const double slack = kSlack + (header.patches ? header.patches->error : 0);
  const double least = geometry.metres(node.record.minimum_height) - slack,
               greatest = geometry.metres(node.record.maximum_height) + slack;
  const double curvature = ellipsoid.least_curvature_radius + least;
  const Vector3& up = volume.up;
  const double a2 = ellipsoid.a * ellipsoid.a, b2 = ellipsoid.b * ellipsoid.b;
  const double support = std::sqrt(a2 * (up.x * up.x + up.y * up.y) + b2 * (up.z * up.z));
  const double centre = dot(up, volume.centre);
  if (ellipsoid.least_curvature_radius + least > 0)
    volume.high = std::min(volume.radius, support + greatest - centre);
  // Where the surface of the least height has the normal `up`, and how far points may be from that axis.
  const Vector3 touching = Vector3{a2 * up.x, a2 * up.y, b2 * up.z} * (1 / support) + up * least;
  const Vector3 beside = volume.centre - touching;
  const double from_axis = length(beside - up * dot(up, beside)) + volume.radius;
  if (from_axis < 0.5 * curvature) {
    const double falls =
        from_axis * from_axis / (curvature + std::sqrt(curvature * curvature - from_axis * from_axis));
    volume.low = std::max(-volume.radius, support + least - falls - centre);
    // x(n) of a body that curves no more than a ball of radius R: |n1 - n2| <= |x1 - x2| / R.
    volume.normal_spread = std::min(2.0, std::hypot(from_axis, falls) / curvature);
  }
  // Only what contradicts the ball, in a damaged record, ends here.
  if (!(volume.low <= volume.high)) {
    volume.low = -volume.radius;
    volume.high = volume.radius;
  }
  const double nearest_middle = std::clamp(0.0, volume.low, volume.high);
  volume.horizontal =
      std::sqrt(std::max(0.0, volume.radius * volume.radius - nearest_middle * nearest_middle));
  return volume;
}

double reachAlong(const NodeVolume& volume, const Vector3& direction) {
  // Concave in the vertical coordinate, so its largest value between the planes is at the clamped maximum.
  const double vertical = std::clamp(dot(volume.up, direction), -1.0, 1.0);
  const double y = std::clamp(volume.radius * vertical, volume.low, volume.high);
  return vertical * y +
         std::sqrt((1 - vertical * vertical) * std::max(0.0, volume.radius * volume.radius - y * y));
}

double leastDistance(const NodeVolume& volume, const Vector3& eye) {
  const Vector3 offset = volume.centre - eye;
  const double along = dot(volume.up, offset);
  const double vertical = std::max({0.0, along + volume.low, -(along + volume.high)});
  const double across = length(offset - volume.up * along) - volume.horizontal;
  return std::max({0.0, length(offset) - volume.radius, std::hypot(std::max(0.0, across), vertical)});
}

std::array<Vector3, 8> boxAround(const NodeVolume& volume, const Vector3& eye) {
  const Vector3 offset = volume.centre - eye;
  Vector3 away = offset - volume.up * dot(volume.up, offset);
  if (!(length(away) > 1e-9 * volume.radius)) {
    // Above or below the middle any direction will do.
    away = std::abs(volume.up.z) < 0.9 ? cross(volume.up, {0, 0, 1}) : cross(volume.up, {1, 0, 0});
  }
  away = normalized(away);
  const Vector3 along = away * volume.horizontal, across = cross(volume.up, away) * volume.horizontal;
  std::array<Vector3, 8> corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    corners[k] = volume.centre + along * ((k & 1) != 0 ? 1.0 : -1.0) + across * ((k & 2) != 0 ? 1.0 : -1.0) +
                 volume.up * ((k & 4) != 0 ? volume.high : volume.low);
  }
  return corners;
}

}  // namespace deltaz
