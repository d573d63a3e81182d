#include "librender/sweep/shown_displacement.h"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/librender/cut_checks.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

ShownDisplacement measured(const Database& truth, const Database& drawn, const Camera& camera,
                           double tolerance) {
  RenderOptions options;
  options.camera = camera;
  options.tolerance = tolerance;
  const Picture picture = draw(EngineKind::kFast, drawn, options);
  const Result<ShownDisplacement> result = measureShownDisplacement(truth, camera, picture, 0);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
  return result.ok() ? result.value() : ShownDisplacement{};
}

TEST(ShownDisplacement, is_next_to_nothing_at_full_resolution) {
  const MemoryDatabase area = makeDatabase(smallArea());
  std::mt19937 random(5);
  for (int view = 0; view < 10; ++view) {
    const Camera camera = randomView(area.database, random, 160, 100);
    const ShownDisplacement shown = measured(area.database, area.database, camera, 0);
    EXPECT_LT(shown.largest, 0.01) << inWords(camera);
    EXPECT_LT(shown.nearly_all, 1e-3) << inWords(camera);
  }
}

// A plane raised by ten metres, seen from straight above its middle at a kilometre: at tangent r a point
// ten metres too high appears r 10 / 990 further out.
TEST(ShownDisplacement, of_a_raised_plane_is_what_geometry_says) {
  SyntheticGridOptions options = smallArea();
  RawGrid grid = syntheticGrid(options);
  std::fill(grid.heights.begin(), grid.heights.end(), 100);
  const MemoryDatabase flat = makeDatabaseOf(grid, 16);
  std::fill(grid.heights.begin(), grid.heights.end(), 110);
  const MemoryDatabase raised = makeDatabaseOf(grid, 16);
  Camera camera = cameraOver(flat.database, 0.5, 0.5, 1000, 0, -90, 201, 101);
  camera.eye.height = 1100;
  const ShownDisplacement shown = measured(flat.database, raised.database, camera, 0);
  ASSERT_EQ(shown.measured, 201u * 101u);
  EXPECT_EQ(shown.unmeasured, 0u);
  const ViewTransform view = makeViewTransform(camera, flat.database.area().grids.front().ellipsoid);
  const double corner = std::hypot(100, 50), expected = corner * 10 / 1000;
  EXPECT_NEAR(shown.largest, expected, expected * 2e-3) << view.pixels;
  EXPECT_LT(shown.nearly_all, shown.largest);
  EXPECT_GT(shown.nearly_all, shown.largest * 0.98);
  EXPECT_LT(shown.root_mean_square, shown.largest * 0.6);
}

// What is seen is part of what is there: no pixel may show more than the scheduler's bound, and a coarse view
// shows about as much as the posts have.
TEST(ShownDisplacement, stays_within_the_tolerance_and_near_what_the_posts_say) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const SeamIndex seams(area.database);
  const FullResolution full(area.database, 0);
  bool coarse = false;
  for (const Camera& camera : {wholeAreaCamera(area.database.area(), 320, 200, 60),
                               cameraOver(area.database, 0.5, 0.5, 20000, 0, -90, 320, 200)}) {
    const ViewTransform view = makeViewTransform(camera, area.database.area().grids.front().ellipsoid);
    for (const double tolerance : {1.0, 4.0, 16.0}) {
      const ShownDisplacement shown = measured(area.database, area.database, camera, tolerance);
      FrameStatistics::Nodes counts;
      const Result<Schedule> schedule = scheduleNodes(area.database, seams, view, {tolerance}, counts);
      ASSERT_TRUE(schedule.ok());
      const double at_posts =
          measureContract(area.database, meshOfCut(area.database, schedule.value(), view), full, view)
              .worst_pixels;
      EXPECT_LE(shown.largest, tolerance + 0.01);
      EXPECT_LE(shown.largest, at_posts * 1.01 + 0.01);
      if (at_posts > 0.3) {
        coarse = true;
        EXPECT_GT(shown.largest, at_posts * 0.3);
      }
    }
  }
  EXPECT_TRUE(coarse);
}

TEST(ShownDisplacement, leaves_out_what_is_neither_terrain_nor_over_ground) {
  SyntheticGridOptions options = smallArea();
  const MemoryDatabase area = makeDatabase(options);
  RawGrid grid = syntheticGrid(options);
  grid.valid.assign(grid.heights.size(), 1);
  for (std::size_t k = 0; k < grid.valid.size() / 2; ++k) grid.valid[k] = 0;
  grid.header.sentinels = {-9999};
  const MemoryDatabase half = makeDatabaseOf(grid, 16);
  const Camera camera = wholeAreaCamera(area.database.area(), 160, 100, 60);
  const ShownDisplacement shown = measured(half.database, area.database, camera, 0);
  const ShownDisplacement whole = measured(area.database, area.database, camera, 0);
  EXPECT_EQ(shown.measured + shown.unmeasured, whole.measured + whole.unmeasured);
  EXPECT_GT(shown.measured, whole.measured / 4);
  EXPECT_GT(shown.unmeasured, whole.measured / 4);
  Picture sky;
  sky.width = 2;
  sky.height = 1;
  sky.depth.assign(2, std::numeric_limits<float>::infinity());
  sky.surface.assign(2, Surface::kSky);
  const Result<ShownDisplacement> nothing = measureShownDisplacement(area.database, camera, sky, 1);
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(nothing.value().measured + nothing.value().unmeasured, 0u);
}

}  // namespace
}  // namespace deltaz
