#include "librender/scene/report_schedule.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

ViewTransform viewOf(double field_of_view, int width, int height) {
  Camera camera;
  camera.field_of_view = field_of_view;
  camera.width = width;
  camera.height = height;
  return makeViewTransform(camera, EllipsoidShape{});
}

GridGeometry gridOf(std::int64_t arc_seconds) {
  SyntheticGridOptions options = smallArea();
  options.columns = options.rows = 17;
  options.spacing_latitude = options.spacing_longitude = {arc_seconds, 1};
  return makeDatabase(options).database.grid(0);
}

TEST(ReportRanges, are_those_that_fit_table_29_in_the_picture_of_the_report) {
  const ReportRanges ranges({}, viewOf(32, 512, 512), gridOf(3));
  EXPECT_NEAR(ranges.largest(1), 10120, 0.5);
  EXPECT_NEAR(ranges.largest(2), 14241, 0.5);
  EXPECT_NEAR(ranges.largest(3), 20040, 0.5);
  EXPECT_NEAR(ranges.largest(4), 28200, 0.5);
  EXPECT_EQ(ranges.largest(5), std::numeric_limits<double>::infinity());
}

TEST(ReportRanges, keep_the_distance_of_posts_on_the_screen_in_other_pictures_and_grids) {
  const double first = ReportRanges({}, viewOf(32, 512, 512), gridOf(3)).largest(1);
  EXPECT_NEAR(ReportRanges({}, viewOf(32, 1024, 100), gridOf(3)).largest(1), 2 * first, 1e-6);
  EXPECT_NEAR(ReportRanges({}, viewOf(32, 512, 512), gridOf(1)).largest(1), first / 3, 1e-6);
  EXPECT_NEAR(ReportRanges({}, viewOf(64, 512, 512), gridOf(3)).largest(1),
              first * std::tan(16 * M_PI / 180) / std::tan(32 * M_PI / 180), 1e-6);
}

TEST(ReportRanges, draw_at_two_levels_in_the_outermost_part_of_a_range_alone) {
  const ReportRanges ranges({10000, 0.5, 0.1}, viewOf(32, 512, 512), gridOf(3));
  EXPECT_EQ(ranges.at(0), (ReportLevels{1, 1}));
  EXPECT_EQ(ranges.at(8999), (ReportLevels{1, 1}));
  EXPECT_EQ(ranges.at(9001), (ReportLevels{1, 2}));
  EXPECT_EQ(ranges.at(9999), (ReportLevels{1, 2}));
  EXPECT_EQ(ranges.at(10001), (ReportLevels{2, 2}));
  EXPECT_EQ(ranges.at(14100), (ReportLevels{2, 3}));
  EXPECT_EQ(ranges.at(19999), (ReportLevels{3, 4}));
  EXPECT_EQ(ranges.at(28200), (ReportLevels{4, 5}));
  EXPECT_EQ(ranges.at(28300), (ReportLevels{5, 5}));
  EXPECT_EQ(ranges.at(1e7), (ReportLevels{5, 5}));
  EXPECT_EQ(ReportRanges({10000, 0.5, 0}, viewOf(32, 512, 512), gridOf(3)).at(9999), (ReportLevels{1, 1}));
}

TEST(ReportRanges, draw_as_large_a_share_of_faces_twice_as_table_29_counted) {
  const ReportRanges ranges({}, viewOf(32, 512, 512), gridOf(3));
  const auto share = [](int level) { return std::ldexp(1.0, 1 - level); };  // of the faces there are
  double faces = 0, twice = 0;
  for (double range = 5; range < 50000; range += 10) {
    const ReportLevels levels = ranges.at(range);
    faces += range * share(levels.finest);
    if (levels.isTwice()) twice += range * share(levels.coarsest);
  }
  EXPECT_NEAR(twice / (faces + twice), 3026.0 / 27265, 0.001);
}

}  // namespace
}  // namespace deltaz
