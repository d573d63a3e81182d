#include "librender/scene/sea_cover.h"

#include <algorithm>
#include <cmath>

namespace deltaz {
namespace {

Vector3 scaled(const SeaTerms& sea, const Vector3& v) {
  return {v.x * sea.inverse_a, v.y * sea.inverse_a, v.z * sea.inverse_b};
}

// half^2 - squared * outside of Sea::depth, as a form of two rays; both parts are positive where a ray meets
// the sea in front of the eye.
struct Discriminant {
  const SeaTerms& sea;
  double half(const Vector3& ray) const { return dot(sea.scaled_eye, ray); }
  double of(const Vector3& a, const Vector3& b) const { return half(a) * half(b) - dot(a, b) * sea.outside; }
  bool meets(const Vector3& ray) const { return half(ray) < 0 && of(ray, ray) >= 0; }
  // Anywhere between the rays a and b, or, if one of them leads down and one up, behind the eye there.
  bool meetsBetween(const Vector3& a, const Vector3& b) const {
    if (half(a) >= 0 && half(b) >= 0) return false;
    // Quadratic in t, from a to b; greatest at an end or at its top in between.
    const double at_a = of(a, a), at_b = of(b, b), mixed = of(a, b);
    if (at_a >= 0 || at_b >= 0) return true;
    const double curvature = at_a - 2 * mixed + at_b;
    if (!(curvature < 0)) return false;
    const double t = (at_a - mixed) / curvature;
    return t > 0 && t < 1 && at_a + t * (mixed - at_a) >= 0;
  }
};

}  // namespace

SeaCover seaCover(const SeaTerms& sea, const ViewTransform& view, double first_j, double first_i,
                  double last_j, double last_i) {
  if (!(sea.outside > 0)) return SeaCover::kNowhere;
  const Discriminant discriminant{sea};
  const Vector3 corners[4] = {scaled(sea, view.ray(first_j, first_i)), scaled(sea, view.ray(last_j, first_i)),
                              scaled(sea, view.ray(last_j, last_i)), scaled(sea, view.ray(first_j, last_i))};
  if (std::all_of(corners, corners + 4, [&](const Vector3& ray) { return discriminant.meets(ray); }))
    return SeaCover::kEverywhere;
  for (int k = 0; k < 4; ++k) {
    if (discriminant.meetsBetween(corners[k], corners[(k + 1) % 4])) return SeaCover::kPartly;
  }
  // All of it may lie inside: then so does the ray through its middle.
  const Vector3 to_middle = sea.eye * -1;
  const double forward = dot(view.forward, to_middle);
  if (!(forward > 0)) return SeaCover::kNowhere;
  const double j = view.centre_j + dot(view.right, to_middle) / forward * view.pixels;
  const double i = view.centre_i + dot(view.down, to_middle) / forward * view.pixels;
  const bool inside = j >= first_j && j <= last_j && i >= first_i && i <= last_i;
  return inside ? SeaCover::kPartly : SeaCover::kNowhere;
}

SeaBound seaBound(const SeaTerms& sea, const ViewTransform& view, double j, double i) {
  const Vector3 ray = scaled(sea, view.ray(j, i));
  const Vector3 right = scaled(sea, view.right * (1 / view.pixels));
  const Vector3 down = scaled(sea, view.down * (1 / view.pixels));
  const Discriminant discriminant{sea};
  const double half = discriminant.half(ray);
  const double root = std::sqrt(std::max(0.0, discriminant.of(ray, ray)));
  // 1/U = (root - half) / outside.
  const auto slope = [&](const Vector3& step) {
    return (discriminant.of(ray, step) / root - discriminant.half(step)) / sea.outside;
  };
  return {j, i, (root - half) / sea.outside, slope(right), slope(down)};
}

}  // namespace deltaz
