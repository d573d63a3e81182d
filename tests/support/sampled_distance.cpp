#include "tests/support/sampled_distance.h"

#include <algorithm>
#include <limits>

namespace deltaz {

namespace {

double distanceToSegment(const Vector3& a, const Vector3& b, const Vector3& p) {
  const Vector3 along = b - a;
  const double t = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
  return length(a + along * t - p);
}

}  // namespace

double distanceToTriangle(const std::array<Vector3, 3>& triangle, const Vector3& p) {
  double least = std::min({distanceToSegment(triangle[0], triangle[1], p),
                           distanceToSegment(triangle[1], triangle[2], p),
                           distanceToSegment(triangle[2], triangle[0], p)});
  const Vector3 normal = normalized(cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
  const double height = dot(p - triangle[0], normal);
  const Vector3 foot = p - normal * height;
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3& a = triangle[k];
    inside = inside && dot(cross(triangle[(k + 1) % 3] - a, foot - a), normal) >= 0;
  }
  if (inside) least = std::min(least, std::abs(height));
  return least;
}

double sampledDistance(const TriangleView& from, const TriangleView& to, int steps) {
  double largest = 0;
  for (std::size_t f = 0; f < from.triangles.size(); ++f) {
    const std::array<Vector3, 3> corners = from.corners(f);
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const double s = static_cast<double>(i) / steps, t = static_cast<double>(j) / steps;
        const Vector3 p = corners[0] * (1 - s - t) + corners[1] * s + corners[2] * t;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < to.triangles.size() && least > largest; ++k)
          least = std::min(least, distanceToTriangle(to.corners(k), p));
        largest = std::max(largest, least);
      }
    }
  }
  return largest;
}

}  // namespace deltaz
