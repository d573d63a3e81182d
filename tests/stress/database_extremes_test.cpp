// Databases of extreme grids: built, read back, checked, and their promises measured.
#include <gtest/gtest.h>

#include "formats/terrain_segment.h"
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

}  // namespace
}  // namespace deltaz
