#include "librender/objects/transform_error_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

constexpr double kSingle = 0x1p-23;
constexpr double kDouble = 0x1p-52;
constexpr double kGeodeticRoundings = 24, kProjectedRoundings = 256, kEyeRoundings = 8;

double g(double roundings) {
  return roundings * kSingle < 1 ? roundings * kSingle / (1 - roundings * kSingle)
                                 : std::numeric_limits<double>::infinity();
}

// Metres of height the delta summation passes through.
struct Climb {
  double first = 0;    // |height of post (0, 0) above the base|
  double longest = 0;  // largest sum of |delta-z| on the way to a post, void posts included
};

Climb climbOf(const TerrainTile& tile, const GridGeometry& geometry, std::int32_t base) {
  const double quantum = geometry.header().quantum.value();
  const auto difference = [&](std::int64_t a, std::int64_t b) {
    return std::abs(static_cast<double>(a - b)) * quantum;
  };
  Climb climb;
  climb.first = difference(tile.height(0, 0), base);
  double up_the_column = 0;
  for (int j = 0; j < tile.rows; ++j) {
    if (j > 0) up_the_column += difference(tile.height(0, j), tile.height(0, j - 1));
    double along_the_row = up_the_column;
    for (int i = 1; i < tile.columns; ++i)
      along_the_row += difference(tile.height(i, j), tile.height(i - 1, j));
    climb.longest = std::max(climb.longest, along_the_row);
  }
  return climb;
}

}  // namespace

double transformErrorBound(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry,
                           const ViewTransform& view) {
  if (tile.columns < 1 || tile.rows < 1) return 0;
  const PlanarGrid planar = planarGridOf(tile, geometry);
  const double root3 = std::sqrt(3.0);
  const double w =
      (length(planar.east) * (tile.columns - 1) + length(planar.north) * (tile.rows - 1)) / 2 +
      (length(planar.east) + length(planar.north)) / 2;  // a projected grid's middle may be half a post off
  const double k = static_cast<double>(planar.height_reach) * geometry.header().quantum.value();
  const double d = length(planar.origin - view.eye);
  const double planarity = planarityBound(tile, geometry);
  const double post = length(planar.origin) + w + k + planarity;
  const double roundings = geometry.isGeodetic() ? kGeodeticRoundings : kProjectedRoundings;
  const double exact = root3 * kDouble * (roundings * post + kEyeRoundings * length(view.eye));
  if (kind == TransformKind::kExact) return exact;

  const Climb climb = kind == TransformKind::kDelta ? climbOf(tile, geometry, planar.base) : Climb{};
  const double largest =
      (d + 2 * (w + k + planarity + climb.first + climb.longest)) * std::max(1.0, view.pixels);
  if (!(largest < static_cast<double>(std::numeric_limits<float>::max()) / 4))
    return std::numeric_limits<double>::infinity();
  switch (kind) {
    case TransformKind::kLocal:
      return root3 * g(6) * (w + k + planarity) + g(2) * d + exact;
    case TransformKind::kMatrix:
      return g(8) * (w + k) + g(2) * d + planarity + exact;
    default: {
      const double sums = tile.columns + tile.rows - 1;
      return g(8) * (w + climb.first) + g(2) * d + g(2) * 2 * w + g(6) * climb.longest +
             g(sums) * (d + w + climb.first + climb.longest) + planarity + exact;
    }
  }
}

double transformPixelBound(double metres, const TerrainTile& tile, const std::vector<Vector3>& position,
                           const ViewTransform& view) {
  if (metres <= 0) return 0;
  const auto at = [&](int i, int j) {
    const Vector3& p = position[static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns) +
                                static_cast<std::size_t>(i)];
    return Vector3{p.x, p.y / view.pixels, p.z / view.pixels};
  };
  double least_depth = std::numeric_limits<double>::infinity(), nearest = least_depth, longest_edge = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) continue;
      const Vector3 here = at(i, j);
      least_depth = std::min(least_depth, here.x);
      nearest = std::min(nearest, length(here));
      const auto edge_to = [&](int to_i, int to_j) {
        if (to_i < tile.columns && to_j < tile.rows && tile.isValid(to_i, to_j))
          longest_edge = std::max(longest_edge, length(at(to_i, to_j) - here));
      };
      edge_to(i + 1, j);
      edge_to(i, j + 1);
      edge_to(i + 1, j + 1);
    }
  }
  if (std::isinf(nearest)) return 0;
  const double slant = std::sqrt(1 + largestTangentSquared(view));
  const double depth = std::max({kHither, least_depth, (nearest - longest_edge / std::sqrt(3.0)) / slant});
  return depth > metres ? view.pixels * metres * slant / (depth - metres)
                        : std::numeric_limits<double>::infinity();
}

}  // namespace deltaz
