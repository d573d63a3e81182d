#include "librender/sweep/sweep.h"

#include <gtest/gtest.h>

#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

SweepRow row(double milliseconds, double displacement, double mean_square) {
  SweepRow row;
  row.milliseconds = {milliseconds, milliseconds, milliseconds};
  row.displacement.largest = displacement;
  row.displacement.measured = 10;
  row.picture.pixels = 10;
  row.picture.mean_square = mean_square;
  return row;
}

TEST(Sweep, measures_every_setting_in_every_view) {
  const MemoryDatabase area = makeDatabase(smallArea());
  SweepRequest request;
  request.views = {{"all", wholeAreaCamera(area.database.area(), 160, 100, 60)},
                   {"down", cameraOver(area.database, 0.5, 0.5, 20000, 0, -90, 160, 100)}};
  request.settings = {{0, 8}, {0, 1}, {0, 0}};
  request.repeats = 2;
  double last = -1;
  request.progress = [&](double fraction) {
    EXPECT_GT(fraction, last);
    EXPECT_LT(fraction, 1);
    last = fraction;
  };
  const Database* const databases[] = {&area.database};
  const Result<std::vector<SweepOfView>> swept = sweep(databases, request);
  ASSERT_TRUE(swept.ok());
  ASSERT_EQ(swept.value().size(), 2u);
  EXPECT_GT(last, 0.9);
  for (const SweepOfView& view : swept.value()) {
    ASSERT_EQ(view.rows.size(), 3u);
    const SweepRow &coarse = view.rows[0], &full = view.rows[2];
    EXPECT_EQ(coarse.setting.tolerance, 8);
    EXPECT_LT(coarse.statistics.triangles.in, full.statistics.triangles.in);
    EXPECT_GT(coarse.displacement.largest, full.displacement.largest);
    EXPECT_EQ(full.picture.differing, 0u);
    EXPECT_GT(coarse.picture.differing, 0u);
    EXPECT_GT(coarse.milliseconds.minimum, 0);
    EXPECT_LE(coarse.milliseconds.median, coarse.milliseconds.maximum);
  }
}

// With many samples for reference; and the ground stays where it is.
TEST(Sweep, more_samples_cost_colour_errors_only) {
  const MemoryDatabase area = makeDatabase(smallArea());
  SweepRequest request;
  request.views = {{"ground", cameraOver(area.database, 0.4, 0.1, 300, 10, -5, 160, 100)}};
  for (const int samples : {1, 4, 16}) {
    SweepSetting setting;
    setting.samples = samples;
    request.settings.push_back(setting);
  }
  request.reference_tolerance = 1;
  request.reference_samples = 64;
  request.repeats = 1;
  double last = -1;
  request.progress = [&](double fraction) {
    EXPECT_GT(fraction, last);
    EXPECT_LT(fraction, 1);
    last = fraction;
  };
  const Database* const databases[] = {&area.database};
  const auto swept = sweep(databases, request);
  ASSERT_TRUE(swept.ok());
  const std::vector<SweepRow>& rows = swept.value()[0].rows;
  EXPECT_GT(rows[0].picture.mean_square, 2 * rows[1].picture.mean_square);
  EXPECT_GT(rows[1].picture.mean_square, 2 * rows[2].picture.mean_square);
  EXPECT_GT(rows[2].picture.mean_square, 0);
  for (const SweepRow& row : rows) EXPECT_EQ(row.displacement.largest, rows[0].displacement.largest);
}

// Errors are those of pictures and do not depend on how often or on how many threads they were drawn.
TEST(Sweep, errors_are_the_same_for_any_number_of_threads) {
  const MemoryDatabase area = makeDatabase(smallArea());
  SweepRequest request;
  request.views = {{"all", wholeAreaCamera(area.database.area(), 160, 100, 60)}};
  request.settings = {{0, 4}};
  const Database* const databases[] = {&area.database};
  request.common.threads = 1;
  request.repeats = 1;
  const auto alone = sweep(databases, request);
  request.common.threads = 2;
  request.repeats = 3;
  const auto together = sweep(databases, request);
  ASSERT_TRUE(alone.ok() && together.ok());
  const SweepRow &a = alone.value()[0].rows[0], &b = together.value()[0].rows[0];
  EXPECT_EQ(a.displacement.largest, b.displacement.largest);
  EXPECT_EQ(a.displacement.nearly_all, b.displacement.nearly_all);
  EXPECT_EQ(a.displacement.root_mean_square, b.displacement.root_mean_square);
  EXPECT_EQ(a.picture.mean_square, b.picture.mean_square);
}

TEST(Sweep, over_all_views_takes_mean_times_and_worst_displacements) {
  const SweepOfView views[] = {{{}, {row(2, 0.5, 4), row(9, 0.1, 0)}},
                               {{}, {row(4, 0.2, 16), row(1, 0.3, 0)}}};
  const std::vector<SweepRow> all = overAllViews(views);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_DOUBLE_EQ(all[0].milliseconds.median, 3);
  EXPECT_DOUBLE_EQ(all[0].displacement.largest, 0.5);
  EXPECT_DOUBLE_EQ(all[0].picture.mean_square, 10);
  EXPECT_DOUBLE_EQ(all[1].milliseconds.median, 5);
  EXPECT_DOUBLE_EQ(all[1].displacement.largest, 0.3);
  EXPECT_EQ(frontOf(all, SweepMeasure::kDisplacement), (std::vector<std::size_t>{0, 1}));
  EXPECT_DOUBLE_EQ(errorOf(all[0], SweepMeasure::kPicture), std::sqrt(10.0));
}

TEST(Sweep, an_error_of_the_engine_ends_it) {
  const MemoryDatabase area = makeDatabase(smallArea());
  SweepRequest request;
  request.views = {{"all", wholeAreaCamera(area.database.area(), 160, 100, 60)}};
  request.settings = {{0, 4}};
  request.common.color_map = "no such map";
  const Database* const databases[] = {&area.database};
  const auto swept = sweep(databases, request);
  ASSERT_FALSE(swept.ok());
  EXPECT_EQ(swept.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace deltaz
