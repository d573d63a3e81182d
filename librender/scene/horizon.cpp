#include "librender/scene/horizon.h"

#include <algorithm>

#include "librender/scene/sea.h"

namespace deltaz {
namespace {

constexpr double kSmaller = 0.01;   // metres
constexpr double kRounding = 1e-9;  // relative, of the two comparisons

Vector3 scaled(const Vector3& p, const Vector3& by) {
  return {p.x * by.x, p.y * by.y, p.z * by.z};
}

}  // namespace

Horizon::Horizon(const AreaHeader& area, const Vector3& eye) : eye_(eye) {
  const SeaAxes axes = seaAxes(area);
  const double inverse_a = 1 / (axes.a - kSmaller), inverse_b = 1 / (axes.b - kSmaller);
  inverse_axes_ = {inverse_a, inverse_a, inverse_b};
  scaled_eye_ = scaled(eye, inverse_axes_);
  outside_ = dot(scaled_eye_, scaled_eye_) - 1;
  // At the sea's own level, or below, nothing is hidden by it.
  const Vector3 of_sea = scaled(eye, {1 / axes.a, 1 / axes.a, 1 / axes.b});
  if (!(dot(of_sea, of_sea) > 1)) outside_ = -1;
}

bool Horizon::hides(const Vector3& point) const {
  if (!(outside_ > 0)) return false;
  const Vector3 ray = scaled(point - eye_, inverse_axes_);
  const double towards = dot(scaled_eye_, ray);
  // Beyond the tangent points' plane: eye . p <= 1. Inside the cone: the ray meets the sphere.
  return towards <= -outside_ * (1 + kRounding) &&
         towards * towards >= outside_ * dot(ray, ray) * (1 + kRounding);
}

bool Horizon::hides(const NodeVolume& volume) const {
  if (!(outside_ > 0)) return false;
  // Most nodes show above the horizon at their middle.
  if (!hides(volume.centre + volume.up * volume.high)) return false;
  const std::array<Vector3, 8> corners = boxAround(volume, eye_);
  return std::all_of(corners.begin(), corners.end(), [&](const Vector3& corner) { return hides(corner); });
}

}  // namespace deltaz
