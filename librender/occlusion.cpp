#include "librender/occlusion.h"

#include "librender/scene/screen_extent.h"

namespace deltaz {
namespace {

// Metres, and relative to the distance from the eye: ten and two times the bound of the exact transform.
constexpr double kMetres = 0.01, kRelative = 0x1p-22;

}  // namespace

bool Occlusion::hides(const NodeVolume& volume) const {
  const double beside = kMetres + kRelative * (length(volume.centre - view_.eye) + volume.radius);
  NodeVolume grown = volume;
  grown.radius += beside;
  grown.horizontal += beside;
  grown.low -= beside;
  grown.high += beside;
  return tiler_.isHidden(screenExtent(view_, grown, margin_));
}

bool Occlusion::hides(const Vector3& centre, double radius) const {
  NodeVolume ball;
  ball.centre = centre;
  ball.radius = ball.horizontal = ball.high = radius;
  ball.low = -radius;
  ball.up = length(centre) > 0 ? normalized(centre) : Vector3{0, 0, 1};
  return hides(ball);
}

}  // namespace deltaz
