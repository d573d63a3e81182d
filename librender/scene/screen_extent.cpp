#include "librender/scene/screen_extent.h"

#include <algorithm>
#include <cmath>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

// Pixels and, relative, 1/U: more than what rounding does.
constexpr double kRounding = 1e-6;

struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// The pixels whose squares, half a pixel around their centres, meet the range.
void toPixels(const Range& range, double margin, int count, int& first, int& last) {
  const double low = std::clamp(std::ceil(range.low - margin - 0.5), 0.0, static_cast<double>(count)),
               high = std::clamp(std::floor(range.high + margin + 0.5), -1.0, static_cast<double>(count - 1));
  first = static_cast<int>(low);
  last = static_cast<int>(high);
}

}  // namespace

ScreenExtent screenExtent(const ViewTransform& view, const NodeVolume& volume, double margin) {
  ScreenExtent extent{0, view.width - 1, 0, view.height - 1, 1 / kHither};
  const double nearest =
      dot(view.forward, volume.centre - view.eye) - reachAlong(volume, view.forward * -1.0);
  if (nearest > kHither) extent.largest_inverse_u = (1 + kRounding) / nearest;
  Range across, downward;
  for (const Vector3& corner : boxAround(volume, view.eye)) {
    const Vector3 p = view.toView(corner);
    if (!(p.x > kHither)) return extent;
    across.add(view.centre_j + p.y / p.x);
    downward.add(view.centre_i + p.z / p.x);
  }
  toPixels(across, margin + kRounding, view.width, extent.first_j, extent.last_j);
  toPixels(downward, margin + kRounding, view.height, extent.first_i, extent.last_i);
  return extent;
}

}  // namespace deltaz
