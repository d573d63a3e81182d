#include "librender/scene/sea.h"

#include <cmath>
#include <limits>

namespace deltaz {
namespace {

constexpr LinearColor kDeepWater{0.016, 0.060, 0.125};

// Positive outside the ellipsoid: |scaled|^2 - 1, about 2 height / radius near the surface. Its rounding,
// some 4e-16, is a height of nanometres.
double outsideOf(const Vector3& scaled) {
  return scaled.x * scaled.x + scaled.y * scaled.y + (scaled.z * scaled.z - 1);
}

}  // namespace

SeaAxes seaAxes(const AreaHeader& area) {
  const EllipsoidShape ellipsoid = area.grids.empty() ? EllipsoidShape{} : area.grids.front().ellipsoid;
  const double flattening = ellipsoid.inverse_flattening != 0 ? 1 / ellipsoid.inverse_flattening : 0;
  const double height = area.lowest_height - area.sea_drop;
  return {ellipsoid.semi_major_axis + height, ellipsoid.semi_major_axis * (1 - flattening) + height};
}

Sea::Sea(const AreaHeader& area, const ViewTransform& view, const Light& light, const Atmosphere& atmosphere)
    : eye_(view.eye), light_(light) {
  const auto [a, b] = seaAxes(area);
  inverse_a_ = 1 / a;
  inverse_b_ = 1 / b;
  scaled_eye_ = {eye_.x * inverse_a_, eye_.y * inverse_a_, eye_.z * inverse_b_};
  outside_ = outsideOf(scaled_eye_);
  deep_ = kDeepWater;
  reflected_ = atmosphere.hazeColor();
}

double Sea::depth(const Vector3& ray) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (outside_ <= 0) return kNone;
  const Vector3 scaled{ray.x * inverse_a_, ray.y * inverse_a_, ray.z * inverse_b_};
  // outside + 2 half u + squared u^2 = 0; the nearer root, in the form that subtracts nothing.
  const double half = dot(scaled_eye_, scaled);
  if (half >= 0) return kNone;
  const double squared = dot(scaled, scaled);
  const double discriminant = half * half - squared * outside_;
  if (discriminant < 0) return kNone;
  return outside_ / (std::sqrt(discriminant) - half);
}

LinearColor Sea::color(const Vector3& ray, double u) const {
  const Vector3 p = eye_ + ray * u;
  const Vector3 normal = normalized(
      {p.x * (inverse_a_ * inverse_a_), p.y * (inverse_a_ * inverse_a_), p.z * (inverse_b_ * inverse_b_)});
  // Water mirrors the more sky the flatter one looks at it (Schlick's approximation, from 2 % at right
  // angles).
  const double facing = 1 + dot(ray, normal) / length(ray);
  const double facing2 = facing * facing;
  const double mirror = 0.02 + 0.98 * (facing2 * facing2 * facing);
  return mix(deep_ * light_.intensity(normal), reflected_, mirror * 0.6);
}

}  // namespace deltaz
