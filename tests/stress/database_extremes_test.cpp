// Databases of extreme grids: built, read back, checked, and their promises measured.
#include <gtest/gtest.h>
#include <limits>

#include "formats/terrain_segment.h"
#include "libdb/build/facet_error.h"
#include "libdb/build/pyramid.h"
#include "tests/stress/promises.h"
#include "tests/stress/stress_grids.h"

namespace deltaz {
namespace {

class ExtremeDatabase : public testing::TestWithParam<NamedGrid> {};

INSTANTIATE_TEST_SUITE_P(, ExtremeDatabase, testing::ValuesIn(extremeGrids()),
                         [](const auto& grid) { return grid.param.name; });

TEST_P(ExtremeDatabase, keeps_its_promises) {
  const NamedGrid& named = GetParam();
  holdToPromises(named, buildInMemory(named.grid, {.leaf_cells = named.leaf_cells}));
}

TEST(DatabaseExtremes, heights_of_two_to_the_30_millimetres) {
  buildOrRefuse({"alternating_2_30_mm", alternatingGrid(kMaximumHeightQuanta, {1, 1000}), 8});
}

TEST(DatabaseExtremes, voids_everywhere) {
  SyntheticGridOptions options;
  options.columns = options.rows = 33;
  NamedGrid named{"voids_everywhere", syntheticGrid(options), 8};
  named.grid.valid.assign(named.grid.heights.size(), 0);
  buildOrRefuse(named);
}

// What a record cannot hold is refused, and nothing is left; what is built keeps every promise.
TEST(Extents, heights_of_two_to_the_30_metres) {
  buildOrRefuse({"alternating_2_30_m", alternatingGrid(kMaximumHeightQuanta, {1, 1}), 8});
}
TEST(Extents, heights_just_within_the_format) {
  buildOrRefuse({"alternating_9_7e9_m", alternatingGrid(kMaximumHeightQuanta, {9, 1}), 8});
}
TEST(Extents, an_ellipsoid_of_a_hundred_thousand_kilometres_all_round) {
  SyntheticGridOptions options;
  options.south = -90;
  options.west = -180;
  options.spacing_latitude = options.spacing_longitude = {7200, 1};
  options.columns = 181;
  options.rows = 91;
  NamedGrid named{"huge_all_round", syntheticGrid(options), 16};
  named.grid.header.ellipsoid = {1e8, 20};
  buildOrRefuse(named);
}

TEST(Extents, heights_beyond_the_format) {
  buildOrRefuse({"alternating_1e11_m", alternatingGrid(kMaximumHeightQuanta, {100, 1}), 8});
}

TEST(Extents, least_spacing_with_small_leaves) {
  SyntheticGridOptions options;
  options.columns = options.rows = 49;
  NamedGrid named{"least_spacing_leaf_16", syntheticGrid(options), 16};
  setPlainAxis(named.grid.header.x_axis, kLongitudeOrigin, 7, kLeastSpacingDegrees, 49);
  setPlainAxis(named.grid.header.y_axis, kLatitudeOrigin, 46, kLeastSpacingDegrees, 49);
  buildOrRefuse(named);
}

TEST(Extents, sums_of_squares_end_at_the_largest_number) {
  const auto sum_of = [](const Rational& quantum) {
    const RawGrid grid = alternatingGrid(kMaximumHeightQuanta, quantum);
    GridHeader header = grid.header;
    header.leaf_cells = 16;
    const GridGeometry geometry(header);
    const PlannedNode leaf = planPyramid(geometry).nodes.back();
    return leafErrors(grid, geometry, 2, leaf.x, leaf.y)[0].sum_of_squares;
  };
  const std::uint64_t small = sum_of({1, 1000000});
  EXPECT_GT(small, 0u);
  // A thousand times the errors: a million times the squares, which no 64 bits hold.
  EXPECT_EQ(sum_of({1, 1000}), std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace deltaz
