// Positions at the ends of every range: the contract of accuracy for the exact transform, the proved bounds
// of all four.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "formats/terrain_segment.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/objects/transform_error_bound.h"
#include "librender/raster/pretiler.h"
#include "librender/scene/view_volume.h"
#include "tests/stress/bound_check.h"
#include "tests/stress/stress_grids.h"
#include "tests/stress/true_positions.h"

namespace deltaz {
namespace {

constexpr double kEyeHeights[] = {0.01, 1.7, 1e3, 1e5, 1e7};  // metres above the middle post

Camera cameraAbove(const TerrainTile& tile, const GridGeometry& geometry, double above, double pitch) {
  const int i = tile.columns / 2, j = tile.rows / 2;
  Camera camera;
  camera.eye = geometry.geodeticAt(tile.first_column + i, tile.first_row + j);
  camera.eye.height = geometry.metres(tile.height(i, j)) + above;
  camera.heading = 37;
  camera.pitch = pitch;
  camera.roll = 3;
  return camera;
}

void checkBounds(const std::string& name, const TerrainTile& tile, const GridGeometry& geometry,
                 const ViewTransform& view, const std::vector<LongVector>& truth) {
  for (const TransformKind kind : kTransformKinds) {
    const Result<std::vector<Vector3>> positions = transformPosts(kind, tile, geometry, view);
    ASSERT_TRUE(positions.ok());
    expectWithin(name + " " + std::string(transformName(kind)),
                 largestError(tile, view, positions.value(), truth),
                 transformErrorBound(kind, tile, geometry, view));
  }
}

// The promise to users: what set-up is given, un-projected, lies within 1 mm + 2^-23 x the eye's distance.
// Prints the largest share of that bound which was used up.
void checkContract(const std::string& name, const TerrainTile& tile, const GridGeometry& geometry,
                   const ViewTransform& view, const std::vector<LongVector>& truth) {
  const std::vector<Vector3> positions = terrainPositions(tile, geometry, view);
  double share = 0;
  std::size_t post = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i, ++post) {
      if (!tile.isValid(i, j) || positions[post].x < kHither) continue;
      const Vector3 back = unproject(view, project(view, positions[post]));
      const LongVector& p = truth[post];
      const LongVector d{static_cast<long double>(back.x) - p.x, static_cast<long double>(back.y) - p.y,
                         static_cast<long double>(back.z) - p.z};
      const LongVector eye = trueView(view, p);
      const auto error = static_cast<double>(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z));
      const auto distance = static_cast<double>(std::sqrt(eye.x * eye.x + eye.y * eye.y + eye.z * eye.z));
      share = std::max(share, error / (1e-3 + std::ldexp(distance, -23)));
    }
  }
  expectWithin(name + " share of 1 mm + 2^-23 distance", share, 1);
}

TEST(PositionExtremes, every_extreme_grid_from_every_height) {
  for (const NamedGrid& named : extremeGrids()) {
    const GridGeometry geometry(named.grid.header, named.grid.patches);
    const TerrainTile tile = wholeTile(named.grid);
    const std::vector<LongVector> truth = truePositions(tile, geometry);
    for (const double above : kEyeHeights) {
      const Camera camera = cameraAbove(tile, geometry, above, above < 1e6 ? -10 : -89);
      const ViewTransform view = makeViewTransform(camera, named.grid.header.ellipsoid);
      const std::string name = named.name + " " + std::to_string(above) + " m";
      checkBounds(name, tile, geometry, view, truth);
      checkContract(name, tile, geometry, view, truth);
    }
  }
}

TEST(PositionExtremes, needle_and_panorama_views) {
  SyntheticGridOptions options;
  const RawGrid grid = syntheticGrid(options);
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  const std::vector<LongVector> truth = truePositions(tile, geometry);
  for (const double field_of_view : {1e-6, 0.001, 179.0, 179.999}) {
    Camera camera = cameraAbove(tile, geometry, 500, -5);
    camera.field_of_view = field_of_view;
    const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
    const std::string name = "field of view " + std::to_string(field_of_view);
    checkBounds(name, tile, geometry, view, truth);
    checkContract(name, tile, geometry, view, truth);
  }
}

TEST(PositionExtremes, heights_at_the_limit_of_the_format) {
  // 2^30 quanta of 9 m: 9.66e9 m, just below kMaximumHeightMetres.
  SyntheticGridOptions options;
  options.columns = options.rows = 17;
  options.quantum = {9, 1};
  RawGrid grid = syntheticGrid(options);
  for (std::size_t k = 0; k < grid.heights.size(); ++k)
    grid.heights[k] = k % 2 == 0 ? kMaximumHeightQuanta : -kMaximumHeightQuanta;
  const GridGeometry geometry(grid.header);
  ASSERT_LT(geometry.metres(kMaximumHeightQuanta), kMaximumHeightMetres);
  const TerrainTile tile = wholeTile(grid);
  Camera camera = cameraAbove(tile, geometry, 0, -80);
  camera.eye.height = 1e10;
  const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
  const std::vector<LongVector> truth = truePositions(tile, geometry);
  checkBounds("heights of 2^30 quanta", tile, geometry, view, truth);
  checkContract("heights of 2^30 quanta", tile, geometry, view, truth);
}

// GeographicLib is what users compare with; the truth of these tests must be its truth.
TEST(PositionExtremes, extended_precision_agrees_with_geographiclib) {
  double largest = 0;
  const EllipsoidShape ellipsoid;
  for (double latitude = -90; latitude <= 90; latitude += 7.5) {
    for (double longitude = -180; longitude <= 540; longitude += 22.5) {
      for (const double height : {-400.0, 0.0, 8848.0, 1e6}) {
        const Vector3 p = toEarthCentred(ellipsoid, {latitude, longitude, height});
        const LongVector q = truePosition(ellipsoid, latitude, longitude, static_cast<long double>(height));
        largest = std::max(
            largest, static_cast<double>(std::sqrt(
                         (static_cast<long double>(p.x) - q.x) * (static_cast<long double>(p.x) - q.x) +
                         (static_cast<long double>(p.y) - q.y) * (static_cast<long double>(p.y) - q.y) +
                         (static_cast<long double>(p.z) - q.z) * (static_cast<long double>(p.z) - q.z))));
      }
    }
  }
  expectWithin("GeographicLib against extended precision, metres", largest, 1e-8);
}

}  // namespace
}  // namespace deltaz
