#include "tests/librender/reference/displacement.h"

#include <gtest/gtest.h>

#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

TEST(Displacement, is_none_at_full_resolution) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const Camera camera = wholeAreaCamera(area.database.area(), 640, 400, 60);
  const Result<Displacement> measured = measureDisplacement(area.database, camera, 0);
  ASSERT_TRUE(measured.ok());
  EXPECT_LT(measured.value().largest_pixels, 1e-6);
  // Posts on edges are seen by several faces.
  EXPECT_GT(measured.value().posts, 121u * 121u);
}

// One post raised by 100 m in a flat area: level 1 does not have it, and misses it by its height.
TEST(Displacement, finds_a_single_lost_peak) {
  SyntheticGridOptions options = smallArea();
  RawGrid grid = syntheticGrid(options);
  std::fill(grid.heights.begin(), grid.heights.end(), 1000);
  // Odd in the global numbering: first + 60 or 61.
  const std::int64_t column = 60 + (grid.header.x_axis.first % 2 == 0 ? 1 : 0);
  const std::int64_t row = 60 + (grid.header.y_axis.first % 2 == 0 ? 1 : 0);
  grid.heights[static_cast<std::size_t>(row * grid.header.x_axis.count + column)] = 1100;
  const MemoryDatabase area = makeDatabaseOf(grid, 16);
  const Camera camera = wholeAreaCamera(area.database.area(), 640, 400, 60);
  const Result<Displacement> measured = measureDisplacement(area.database, camera, 1);
  ASSERT_TRUE(measured.ok());
  EXPECT_NEAR(measured.value().largest_metres, 100, 0.01);
}

TEST(Displacement, stays_within_the_tolerance_the_engine_was_given) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const Camera cameras[] = {wholeAreaCamera(area.database.area(), 640, 400, 60),
                            cameraOver(area.database, 0.5, -3, 2000, 0, -5, 640, 400),
                            cameraOver(area.database, 0.5, -12, 8000, 0, -5, 640, 400),
                            cameraOver(area.database, 0.5, 0.5, 400000, 0, -90, 640, 400)};
  bool coarse = false;
  for (const Camera& camera : cameras) {
    for (const double tolerance : {0.25, 1.0, 4.0, 20.0}) {
      RenderOptions options;
      options.camera = camera;
      options.tolerance = tolerance;
      FrameStatistics statistics;
      draw(EngineKind::kFast, area.database, options, statistics);
      const Result<Displacement> measured = measureDisplacement(area.database, camera, statistics.level);
      ASSERT_TRUE(measured.ok());
      EXPECT_LE(measured.value().largest_pixels, statistics.projected_error + 1e-6);
      EXPECT_LE(statistics.projected_error, tolerance);
      coarse = coarse || statistics.level > 0;
    }
  }
  EXPECT_TRUE(coarse);
}

}  // namespace
}  // namespace deltaz
