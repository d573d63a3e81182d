#include "libdb/source/grid_placement.h"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "libdb/access/grid_geometry.h"

namespace deltaz {
namespace {

TEST(GridPlacement, spacings_that_were_rounded_in_the_file_become_exact) {
  // What GDAL reports for SRTM3, SRTM1, DTED0 and a third of an arc-second.
  struct Case {
    double spacing;
    Rational expected;
  };
  for (const auto& [spacing, expected] :
       {Case{0.0008333333333333, {3, 1}}, Case{0.0002777777777778, {1, 1}}, Case{0.0083333333333333, {30, 1}},
        Case{1.0 / 3 / 3600, {1, 3}}, Case{0.00025, {9, 10}}}) {
    const GridAxis axis = placeAxis(-122, spacing, 1201, kLongitudeOrigin);
    ASSERT_TRUE(axis.exact_spacing.has_value()) << spacing;
    EXPECT_EQ(*axis.exact_spacing, expected);
    EXPECT_EQ(axis.phase, 0);
    EXPECT_EQ(postCoordinate(axis, kLongitudeOrigin, axis.first), -122);
  }
}

TEST(GridPlacement, pixel_centred_global_grids_keep_their_half_post_phase) {
  const GridAxis axis = placeAxis(-180 + 0.125, 0.25, 1440, kLongitudeOrigin);
  EXPECT_NEAR(axis.phase, 0.5, 1e-12);
  EXPECT_EQ(axis.first, 0);
}

RC_GTEST_PROP(GridPlacement, posts_stay_where_the_source_has_them, ()) {
  const double spacing = *rc::gen::element(3.0 / 3600, 0.000833333, 0.0002777778, 0.1, 1e-5,
                                           *rc::gen::inRange(1, 1000000) * 1e-8);
  const double first = *rc::gen::inRange(-180000000, 180000000) * 1e-6;
  const std::int64_t count = *rc::gen::inRange<std::int64_t>(2, 4000);
  const GridAxis axis = placeAxis(first, spacing, count, kLongitudeOrigin);
  RC_ASSERT(axis.phase >= 0 && axis.phase < 1);
  RC_ASSERT(axis.count == count);
  for (const std::int64_t k : {std::int64_t{0}, count / 2, count - 1}) {
    const double place = postCoordinate(axis, kLongitudeOrigin, axis.first + k);
    RC_ASSERT(std::abs(place - (first + static_cast<double>(k) * spacing)) <= kPlacementTolerance);
  }
}

}  // namespace
}  // namespace deltaz
