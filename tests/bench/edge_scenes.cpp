#include "tests/bench/edge_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "librender/antialias/sample_grid.h"
#include "librender/raster/coverage.h"
#include "librender/raster/tile_rasterizer.h"

namespace deltaz {
namespace {

constexpr double kMiddle = kScenePixels / 2.0 - 0.3;  // of the scenes; no symmetric place
constexpr double kFar = 200;                          // pixels: beyond the picture

ScreenPoint along(double angle, double length) {
  return {kMiddle + length * std::cos(angle), kMiddle + length * std::sin(angle)};
}
ScreenPoint moved(ScreenPoint p, double angle, double by) {
  return {p.x + by * std::cos(angle), p.y + by * std::sin(angle)};
}

// From the line through the middle at `angle`, moved across by `from`, to the one moved by `to`.
ConvexPolygon strip(double angle, double from, double to) {
  const double across = angle + std::numbers::pi / 2;
  const ScreenPoint a = along(angle, -kFar), b = along(angle, kFar);
  return {moved(a, across, from), moved(b, across, from), moved(b, across, to), moved(a, across, to)};
}

EdgeScenes halfPlanes() {
  EdgeScenes scenes{"edges", {}};
  for (int n = 0; n < 48; ++n)
    scenes.scenes.push_back({{strip((n * 7.5 + 1.3) * std::numbers::pi / 180, 0.1 * (n % 7), kFar)}});
  return scenes;
}

EdgeScenes wires() {
  EdgeScenes scenes{"wires", {}};
  for (int n = 0; n < 24; ++n) {
    const double place = 0.13 * n;
    scenes.scenes.push_back({{strip((n * 7.5 + 1.3) * std::numbers::pi / 180, place, place + 0.4)}});
  }
  return scenes;
}

// Squares of a level ground one unit below the eye, the horizon above the picture's middle.
EdgeScenes checker() {
  constexpr double kHorizon = 8.37, kPixels = 40, kSide = 0.5, kFarthest = 60;
  EdgeScene scene;
  const auto at = [&](double x, double z) {
    return ScreenPoint{kMiddle + kPixels * x / z, kHorizon + kPixels / z};
  };
  for (int row = 1; row * kSide < kFarthest; ++row) {
    const double near = row * kSide, far = near + kSide;
    const int across = static_cast<int>(std::ceil((kScenePixels + 8) / 2.0 / kPixels * far / kSide)) + 1;
    for (int column = -across; column < across; ++column) {
      if ((row + column) % 2 != 0) continue;
      const double left = column * kSide + 0.17, right = left + kSide;
      scene.polygons.push_back({at(left, near), at(right, near), at(right, far), at(left, far)});
    }
  }
  return {"horizon", {scene}};
}

EdgeScenes fan() {
  constexpr int kWedges = 60;
  EdgeScene scene;
  for (int n = 0; n < kWedges; ++n) {
    const double angle = (n + 0.21) * 2 * std::numbers::pi / kWedges;
    scene.polygons.push_back(
        {along(0, 0), along(angle, kFar), along(angle + std::numbers::pi / kWedges, kFar)});
  }
  return {"fan", {scene}};
}

// Clockwise on the screen, in pixels of the sample grid from its middle.
std::vector<RasterTriangle> trianglesOf(const EdgeScene& scene, int across) {
  std::vector<RasterTriangle> triangles;
  const auto vertex = [&](const ScreenPoint& p) {
    const auto place = [&](double pixels) {
      return static_cast<float>((pixels - (kScenePixels - 1) / 2.0) * across);
    };
    return RasterVertex{place(p.x), place(p.y), 1, 0};
  };
  for (const ConvexPolygon& polygon : scene.polygons) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      RasterTriangle triangle{};
      triangle.vertex[0] = vertex(polygon[0]);
      triangle.vertex[1] = vertex(polygon[k]);
      triangle.vertex[2] = vertex(polygon[k + 1]);
      SnappedTriangle snapped;
      for (std::size_t n = 0; n < 3; ++n) {
        snapped.x[n] = snappedCoordinate(triangle.vertex[n].x, kScenePixels * across);
        snapped.y[n] = snappedCoordinate(triangle.vertex[n].y, kScenePixels * across);
      }
      const std::int64_t area = doubledArea(snapped);
      if (area < 0) std::swap(triangle.vertex[1], triangle.vertex[2]);
      if (area != 0) triangles.push_back(triangle);
    }
  }
  return triangles;
}

}  // namespace

std::vector<EdgeScenes> edgeScenes() {
  return {halfPlanes(), wires(), checker(), fan()};
}

EdgeScenes movingWire() {
  EdgeScenes scenes{"moving wire", {}};
  for (const double degrees : {0.0, 3.0, 45.0, 87.0, 90.0}) {
    for (int step = 0; step < 32; ++step) {
      const double place = step / 32.0;
      scenes.scenes.push_back({{strip(degrees * std::numbers::pi / 180, place, place + 0.4)}});
    }
  }
  return scenes;
}

std::vector<double> drawnCoverage(const EdgeScene& scene, const Sampling& sampling) {
  const SampleGrid grid(sampling);
  const int across = grid.across(), side = kScenePixels * across, tiles = (side + kTileSide - 1) / kTileSide;
  const std::vector<RasterTriangle> triangles = trianglesOf(scene, across);
  std::vector<const RasterTriangle*> pointers;
  for (const RasterTriangle& triangle : triangles) pointers.push_back(&triangle);
  std::vector<std::uint8_t> covered(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const auto buffer = std::make_unique<TileBuffer>();
  for (int tile = 0; tile < tiles * tiles; ++tile) {
    const int tile_j = tile % tiles, tile_i = tile / tiles;
    TileCounts counts;
    buffer->clear();
    rasterizeTile({tile_j, tile_i, side, side, grid.offsets()}, pointers, 0, {}, *buffer, counts);
    for (int i = 0; i < std::min(kTileSide, side - tile_i * kTileSide); ++i) {
      for (int j = 0; j < std::min(kTileSide, side - tile_j * kTileSide); ++j) {
        covered[static_cast<std::size_t>((tile_i * kTileSide + i) * side + tile_j * kTileSide + j)] =
            buffer->inverse_u[tileIndex(j, i)] > 0;
      }
    }
  }
  const FilterKernel kernel(sampling);
  std::vector<double> picture(kScenePixels * kScenePixels, 0);
  for (int i = kSceneBorder; i < kScenePixels - kSceneBorder; ++i) {
    for (int j = kSceneBorder; j < kScenePixels - kSceneBorder; ++j) {
      double sum = 0;
      for (int di = -kernel.reach(); di <= kernel.reach(); ++di) {
        for (int dj = -kernel.reach(); dj <= kernel.reach(); ++dj) {
          for (int s = 0; s < sampling.count; ++s) {
            const int row = (i + di) * across + s / across, column = (j + dj) * across + s % across;
            if (covered[static_cast<std::size_t>(row * side + column)] != 0) sum += kernel.weight(dj, di, s);
          }
        }
      }
      picture[static_cast<std::size_t>(i * kScenePixels + j)] =
          sum / kernel.sum(j, i, kScenePixels, kScenePixels);
    }
  }
  return picture;
}

std::vector<double> exactCoverage(const EdgeScene& scene, FilterKind filter) {
  std::vector<double> picture(kScenePixels * kScenePixels, 0);
  const double radius = filterRadius(filter);
  for (const ConvexPolygon& polygon : scene.polygons) {
    std::array<double, 4> box = {1e300, -1e300, 1e300, -1e300};
    for (const ScreenPoint& p : polygon) {
      box = {std::min(box[0], p.x), std::max(box[1], p.x), std::min(box[2], p.y), std::max(box[3], p.y)};
    }
    for (int i = kSceneBorder; i < kScenePixels - kSceneBorder; ++i) {
      if (i + radius < box[2] || i - radius > box[3]) continue;
      for (int j = kSceneBorder; j < kScenePixels - kSceneBorder; ++j) {
        if (j + radius < box[0] || j - radius > box[1]) continue;
        picture[static_cast<std::size_t>(i * kScenePixels + j)] += analyticCoverage(polygon, filter, j, i);
      }
    }
  }
  return picture;
}

double meanSquare(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  constexpr int kJudged = kScenePixels - 2 * kSceneBorder;
  return sum / (kJudged * kJudged);
}

double sumOf(const std::vector<double>& picture) {
  double sum = 0;
  for (const double value : picture) sum += value;
  return sum;
}

}  // namespace deltaz
