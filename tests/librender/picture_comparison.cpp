#include "tests/librender/picture_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

struct ScreenPoint {
  double j = 0, i = 0;
};

double distanceToSegment(const ScreenPoint& p, const ScreenPoint& a, const ScreenPoint& b) {
  const double dj = b.j - a.j, di = b.i - a.i, squared = dj * dj + di * di;
  const double t = squared > 0 ? std::clamp(((p.j - a.j) * dj + (p.i - a.i) * di) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(p.j - (a.j + t * dj), p.i - (a.i + t * di));
}

// Where the edge a-b meets the hither plane.
Vector3 atHither(const Vector3& a, const Vector3& b) {
  return a + (b - a) * ((kHither - a.x) / (b.x - a.x));
}

// Shortens `distance[k]` to the distance from pixels[k] to the line from a to b, given in view space in front
// of the eye.
void approachLine(const ViewTransform& view, const Vector3& a, const Vector3& b,
                  const std::vector<ScreenPoint>& pixels, std::vector<double>& distance) {
  const ScreenPoint from{view.centre_j + a.y / a.x, view.centre_i + a.z / a.x};
  const ScreenPoint to{view.centre_j + b.y / b.x, view.centre_i + b.z / b.x};
  for (std::size_t k = 0; k < pixels.size(); ++k)
    distance[k] = std::min(distance[k], distanceToSegment(pixels[k], from, to));
}

// The same for what of a face's outline lies beyond the hither plane, and for the cut along that plane.
void approach(const ViewTransform& view, const std::array<Vector3, 3>& face,
              const std::vector<ScreenPoint>& pixels, std::vector<double>& distance) {
  std::vector<Vector3> cut;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 &a = face[k], &b = face[(k + 1) % 3];
    const bool a_beyond = a.x > kHither, b_beyond = b.x > kHither;
    if (!a_beyond && !b_beyond) continue;
    if (a_beyond != b_beyond) cut.push_back(atHither(a, b));
    approachLine(view, a_beyond ? a : cut.back(), b_beyond ? b : cut.back(), pixels, distance);
  }
  if (cut.size() == 2) approachLine(view, cut[0], cut[1], pixels, distance);
}

template <typename T>
T require(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

double farthestFromEdges(const Database& database, const Camera& camera,
                         const std::vector<ScreenPoint>& pixels) {
  if (pixels.empty()) return 0;
  const ViewTransform view = makeViewTransform(camera, database.area().grids.front().ellipsoid);
  std::vector<double> distance(pixels.size(), HUGE_VAL);
  for (int grid = 0; grid < database.gridCount(); ++grid) {
    const GridGeometry& geometry = database.grid(grid);
    for (const Node& node : require(nodesOfLevel(database, grid, 0))) {
      const TerrainTile tile = require(database.terrain(node));
      std::vector<Vector3> position;
      for (int j = 0; j < tile.rows; ++j) {
        for (int i = 0; i < tile.columns; ++i) {
          position.push_back(view.toView(geometry.placeAt(tile.first_column + i, tile.first_row + j)
                                             .at(geometry.metres(tile.height(i, j)))));
        }
      }
      for (int j = 0; j + 1 < tile.rows; ++j) {
        for (int i = 0; i + 1 < tile.columns; ++i) {
          const auto at = [&](int di, int dj) -> const Vector3& {
            return position[static_cast<std::size_t>(j + dj) * static_cast<std::size_t>(tile.columns) +
                            static_cast<std::size_t>(i + di)];
          };
          if (tile.bottomFaceValid(i, j)) approach(view, {at(0, 0), at(1, 0), at(1, 1)}, pixels, distance);
          if (tile.topFaceValid(i, j)) approach(view, {at(0, 0), at(1, 1), at(0, 1)}, pixels, distance);
        }
      }
    }
  }
  return *std::max_element(distance.begin(), distance.end());
}

}  // namespace

PictureDifference comparePictures(const Database& database, const Camera& camera, const Picture& a,
                                  const Picture& b) {
  PictureDifference difference;
  difference.pixels = a.surface.size();
  std::vector<ScreenPoint> coverage;
  for (std::size_t pixel = 0; pixel < a.surface.size(); ++pixel) {
    int largest = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      largest = std::max(largest, std::abs(a.rgb[3 * pixel + channel] - b.rgb[3 * pixel + channel]));
    difference.largest = std::max(difference.largest, largest);
    if (largest > 2) ++difference.differing;
    if ((a.surface[pixel] == Surface::kTerrain) != (b.surface[pixel] == Surface::kTerrain)) {
      ++difference.coverage;
      coverage.push_back({static_cast<double>(pixel % static_cast<std::size_t>(a.width)),
                          static_cast<double>(pixel / static_cast<std::size_t>(a.width))});
    } else if (a.surface[pixel] == Surface::kTerrain && !a.triangle.empty() && !b.triangle.empty() &&
               a.triangle[pixel] == b.triangle[pixel]) {
      const double ua = static_cast<double>(a.depth[pixel]), ub = static_cast<double>(b.depth[pixel]);
      difference.largest_depth_difference =
          std::max(difference.largest_depth_difference, std::abs(ua - ub) / ub);
    }
  }
  difference.farthest_from_edge = farthestFromEdges(database, camera, coverage);
  return difference;
}

}  // namespace deltaz
