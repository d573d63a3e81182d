#include "librender/raster/clipper.h"

#include <cstdint>

#include "librender/raster/raster_triangle.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

ClipVertex crossing(const ClipVertex& inside, double inside_distance, const ClipVertex& outside,
                    double outside_distance) {
  const double t = inside_distance / (inside_distance - outside_distance);
  return {inside.position + (outside.position - inside.position) * t,
          inside.weight1 + (outside.weight1 - inside.weight1) * t,
          inside.weight2 + (outside.weight2 - inside.weight2) * t};
}

}  // namespace

ClipPolygon::ClipPolygon(const std::array<Vector3, 3>& corners) : size_(3) {
  corners_[0] = {corners[0], 0, 0};
  corners_[1] = {corners[1], 1, 0};
  corners_[2] = {corners[2], 0, 1};
}

void ClipPolygon::clip(const Vector3& plane, double offset) {
  std::array<ClipVertex, 8> kept;
  std::size_t count = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const ClipVertex &from = corners_[k], &to = corners_[k + 1 < size_ ? k + 1 : 0];
    const double from_side = dot(plane, from.position) - offset, to_side = dot(plane, to.position) - offset;
    if (from_side >= 0) kept[count++] = from;
    if ((from_side >= 0) != (to_side >= 0)) {
      kept[count++] =
          from_side >= 0 ? crossing(from, from_side, to, to_side) : crossing(to, to_side, from, from_side);
    }
  }
  corners_ = kept;
  size_ = count;
}

void ClipPolygon::clipToHither() {
  clip({1, 0, 0}, kHither);
}

void ClipPolygon::clipToGuardBand() {
  const double guard = kGuardBand;
  clip({guard, 1, 0}, 0);
  clip({guard, -1, 0}, 0);
  clip({guard, 0, 1}, 0);
  clip({guard, 0, -1}, 0);
}

bool isOutsidePicture(const std::array<Vector3, 3>& corners, int width, int height) {
  // Half spaces through the eye, valid for any sign of U.
  std::uint32_t common = 31;
  for (const Vector3& p : corners) {
    const double across = width / 2.0 * p.x, downward = height / 2.0 * p.x;
    common &= (p.x < kHither ? 1U : 0) | (p.y < -across ? 2U : 0) | (p.y > across ? 4U : 0) |
              (p.z < -downward ? 8U : 0) | (p.z > downward ? 16U : 0);
  }
  return common != 0;
}

}  // namespace deltaz
