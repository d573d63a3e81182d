#include "librender/scene/projected_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// Relative; more than what rounding makes of a few dozen operations on distances.
constexpr double kRounding = 1 + 1e-9;

double sineOf(double cosine) {
  return std::sqrt(std::max(0.0, 1 - cosine * cosine));
}

// What is known of all points of a volume that are in the picture.
struct Bounds {
  Bounds(const ViewTransform& view, const NodeVolume& volume)
      : offset(volume.centre - view.eye), distance(leastDistance(volume, view.eye)) {
    const double corner = 1 / std::sqrt(1 + largestTangentSquared(view));
    cosine = corner;
    // The slant of the centre's ray, and by how much others in the ball differ from it.
    const double to_centre = length(offset);
    if (to_centre > volume.radius) {
      const double cosine_centre = std::clamp(dot(view.forward, offset) / to_centre, -1.0, 1.0);
      const double sine_spread = volume.radius / to_centre, cosine_spread = sineOf(sine_spread);
      // Only where the sum stays below a half turn is it the slant's bound.
      if (cosine_centre > -cosine_spread)
        cosine = std::max(cosine, cosine_centre * cosine_spread - sineOf(cosine_centre) * sine_spread);
    }
    depth = std::max(distance * cosine, dot(view.forward, offset) - reachAlong(volume, view.forward * -1.0));
  }

  // Pixels of displacements of `error` with sin(angle) / |p| up to `sine_over_distance`.
  double pixels(const ViewTransform& view, double error, double along_axis, double sine_over_distance) const {
    const double left = depth - error * std::min(1.0, along_axis);
    if (!(left > 0) || !(distance > 0)) return kUnbounded;
    return view.pixels * error * sine_over_distance / (cosine * cosine) * (depth / left) * kRounding;
  }

  Vector3 offset;
  double distance = 0;  // of the nearest point
  double cosine = 0;    // of the largest slant
  double depth = 0;     // U of the nearest point
};

}  // namespace

double projectedErrorBound(const ViewTransform& view, const Vector3& centre, double radius, double error) {
  if (error == 0) return 0;
  if (!(error < kUnbounded)) return error;
  const Vector3 offset = centre - view.eye;
  const double tangent_squared = largestTangentSquared(view);
  // Two lower bounds of the depth of a point of the sphere that is in the picture: the sphere's nearest
  // depth, and, because |p| = U sqrt(1 + t^2), its nearest distance divided by the picture's largest slant.
  const double nearest_depth = dot(view.forward, offset) - radius;
  const double nearest_slant = (length(offset) - radius) / std::sqrt(1 + tangent_squared);
  const double depth = std::max(nearest_depth, nearest_slant) - error;
  if (!(depth > 0)) return kUnbounded;
  return view.pixels * error * std::sqrt(1 + tangent_squared) / depth;
}

double projectedErrorBound(const ViewTransform& view, const NodeVolume& volume, double error) {
  if (error == 0) return 0;
  if (!(error < kUnbounded)) return error;
  const Bounds bounds(view, volume);
  return bounds.pixels(view, error, 1, 1 / bounds.distance);
}

double projectedHeightErrorBound(const ViewTransform& view, const NodeVolume& volume, double error) {
  if (error == 0) return 0;
  if (!(error < kUnbounded)) return error;
  const Bounds bounds(view, volume);
  if (!(bounds.distance > 0)) return kUnbounded;
  const double along = dot(volume.up, bounds.offset);
  const double across = length(bounds.offset - volume.up * along);
  const double least_across = std::max(0.0, across - volume.horizontal),
               most_across = across + volume.horizontal;
  const double least_vertical = std::max({0.0, along + volume.low, -(along + volume.high)});
  double sine_over_distance = 1 / bounds.distance;
  if (least_vertical > 0) {
    // Of the points in the picture none is farther from the vertical through the eye than the picture's
    // corners.
    double at = most_across;
    const double corner = 1 / std::sqrt(1 + largestTangentSquared(view)), corner_sine = sineOf(corner);
    const double axis = std::clamp(dot(view.forward, volume.up) * (along < 0 ? -1.0 : 1.0), -1.0, 1.0),
                 axis_sine = sineOf(axis);
    const double cosine = axis * corner - axis_sine * corner_sine;
    if (cosine > 0) at = std::min(at, least_vertical * (axis_sine * corner + axis * corner_sine) / cosine);
    // r / (r^2 + v^2) is largest where r = v.
    at = std::clamp(least_vertical, std::min(least_across, at), at);
    sine_over_distance = std::min(sine_over_distance, at / (at * at + least_vertical * least_vertical));
  } else if (least_across > 0) {
    sine_over_distance = std::min(sine_over_distance, 1 / least_across);
  }
  const double lean = volume.normal_spread / bounds.distance;
  return bounds.pixels(view, error, std::abs(dot(view.forward, volume.up)) + volume.normal_spread,
                       std::min(1 / bounds.distance, sine_over_distance + lean));
}

}  // namespace deltaz
