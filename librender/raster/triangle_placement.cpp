#include "librender/raster/triangle_placement.h"

#include <algorithm>

namespace deltaz {

TrianglePlacement placeTriangle(const std::array<std::int32_t, 3>& x, const std::array<std::int32_t, 3>& y,
                                int width, int height, std::int32_t reach) {
  const std::int32_t least_x = std::min({x[0], x[1], x[2]}), greatest_x = std::max({x[0], x[1], x[2]});
  const std::int32_t least_y = std::min({y[0], y[1], y[2]}), greatest_y = std::max({y[0], y[1], y[2]});
  const std::int32_t last_x = (width - 1) * kSubPixels, last_y = (height - 1) * kSubPixels;
  if (greatest_x < -reach || least_x > last_x + reach || greatest_y < -reach || least_y > last_y + reach)
    return {TriangleFate::kOutside, {}};
  const std::int64_t area = (std::int64_t{x[1]} - x[0]) * (std::int64_t{y[2]} - y[0]) -
                            (std::int64_t{x[2]} - x[0]) * (std::int64_t{y[1]} - y[0]);
  if (area < 0) return {TriangleFate::kBackFacing, {}};
  const std::int32_t first_j = std::max(0, (least_x - reach + kSubPixels - 1) >> kSubPixelBits);
  const std::int32_t first_i = std::max(0, (least_y - reach + kSubPixels - 1) >> kSubPixelBits);
  const std::int32_t last_j = std::min(greatest_x + reach, last_x) >> kSubPixelBits;
  const std::int32_t last_i = std::min(greatest_y + reach, last_y) >> kSubPixelBits;
  if (area == 0 || first_j > last_j || first_i > last_i) return {TriangleFate::kNoSample, {}};
  return {TriangleFate::kKept,
          {first_j / kTileSide, first_i / kTileSide, last_j / kTileSide, last_i / kTileSide}};
}

ClippedFace clipFace(const std::array<Vector3, 3>& corners_of_face) {
  ClipPolygon polygon(corners_of_face);
  polygon.clipToHither();
  polygon.clipToGuardBand();
  ClippedFace face;
  if (polygon.corners().size() < 3) return face;
  const double limit = kGuardBand;
  for (const ClipVertex& corner : polygon.corners()) {
    const double inverse_u = 1 / corner.position.x;
    // Rounding may put a corner that was cut at the guard band beyond it.
    const auto on_screen = [&](double p) {
      return static_cast<float>(std::clamp(p * inverse_u, -limit, limit));
    };
    face.corner[face.corners] = {on_screen(corner.position.y), on_screen(corner.position.z),
                                 static_cast<float>(inverse_u), 0};
    face.weight[face.corners] = {static_cast<float>(corner.weight1), static_cast<float>(corner.weight2)};
    ++face.corners;
  }
  return face;
}

}  // namespace deltaz
