#include "libdb/build/build_terrain.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "libdb/export/export_terrain.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

void expectExact(const RawGrid& grid, const BuildOptions& options = {}) {
  const MemoryFileSystem files = buildInMemory(grid, options);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  const Result<RawGrid> back = readGrid(database.value(), 0, 0);
  ASSERT_TRUE(back.ok()) << back.error().message();
  ASSERT_EQ(back.value().heights.size(), grid.heights.size());
  for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
    for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column) {
      ASSERT_EQ(back.value().isValid(column, row), grid.isValid(column, row));
      if (grid.isValid(column, row)) {
        ASSERT_EQ(back.value().height(column, row), grid.height(column, row));
      }
    }
  }
  CheckOptions check;
  check.against = &grid;
  const Report report = checkDatabase(files, kMemoryDatabasePath, check);
  for (const IssueGroup& group : report.groups) {
    if (group.severity == Severity::kError) ADD_FAILURE() << group.first.front().message;
  }
  EXPECT_TRUE(report.complete);
}

TEST(BuildTerrain, areas_of_any_size_and_place_come_back_exactly) {
  for (const auto& [columns, rows] : std::initializer_list<std::pair<int, int>>{
           {2, 2}, {2, 70}, {65, 65}, {66, 64}, {200, 3}, {130, 131}}) {
    for (const double west : {-180.0, -80.0, 179.9}) {
      SyntheticGridOptions options;
      options.columns = columns;
      options.rows = rows;
      options.west = west;
      expectExact(syntheticGrid(options));
    }
  }
}

TEST(BuildTerrain, poles_antimeridian_and_equator_come_back_exactly) {
  for (const double south : {-90.0, -0.5, 89.0}) {
    SyntheticGridOptions options;
    options.south = south;
    options.west = 179.5;
    options.voids = VoidPattern::kScattered;
    expectExact(syntheticGrid(options), {.leaf_cells = 16});
  }
}

TEST(BuildTerrain, voids_of_every_pattern_come_back_exactly) {
  for (const VoidPattern voids :
       {VoidPattern::kScattered, VoidPattern::kHole, VoidPattern::kWestHalf, VoidPattern::kSingle}) {
    SyntheticGridOptions options;
    options.voids = voids;
    expectExact(syntheticGrid(options), {.leaf_cells = 32});
  }
}

TEST(BuildTerrain, heights_at_the_limits_come_back_exactly) {
  SyntheticGridOptions options;
  options.lowest = -kMaximumHeightQuanta;
  options.highest = kMaximumHeightQuanta;
  options.columns = options.rows = 20;
  options.quantum = {1, 1000000};
  expectExact(syntheticGrid(options), {.leaf_cells = 8});
}

TEST(BuildTerrain, bytes_do_not_depend_on_the_number_of_threads) {
  SyntheticGridOptions options;
  options.voids = VoidPattern::kHole;
  const RawGrid grid = syntheticGrid(options);
  const MemoryFileSystem one = buildInMemory(grid, {.leaf_cells = 16, .threads = 1});
  for (const int threads : {2, 7}) {
    const MemoryFileSystem several = buildInMemory(grid, {.leaf_cells = 16, .threads = threads});
    for (const std::string& name : one.list(kMemoryDatabasePath).value()) {
      EXPECT_EQ(one.bytes(kMemoryDatabasePath + "/" + name), several.bytes(kMemoryDatabasePath + "/" + name))
          << name;
    }
  }
}

TEST(BuildTerrain, leaves_begin_at_global_multiples_whatever_the_area) {
  SyntheticGridOptions options;
  options.west = -80 + 17 * 30.0 / 3600;
  const RawGrid shifted = syntheticGrid(options);
  const MemoryFileSystem files = buildInMemory(shifted);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const Result<std::vector<Node>> leaves = nodesOfLevel(database.value(), 0, 0);
  for (const Node& leaf : leaves.value()) {
    const TerrainTile tile = database.value().terrain(leaf).value();
    const bool first = tile.first_column == shifted.header.x_axis.first;
    EXPECT_TRUE(first || tile.first_column % 64 == 0) << tile.first_column;
  }
}

TEST(BuildTerrain, progress_never_falls_and_ends_at_one) {
  double last = 0;
  BuildOptions options;
  options.progress = [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
  };
  buildInMemory(syntheticGrid(), options);
  EXPECT_EQ(last, 1);
}

TEST(BuildTerrain, a_leaf_size_that_cannot_be_is_refused) {
  const MemoryFileSystem files;
  for (const int leaf : {0, -64, 7, 100, 4096}) {
    const Result<BuildSummary> result =
        buildTerrain(files, syntheticGrid(), kMemoryDatabasePath, {.leaf_cells = leaf});
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
  }
}

// Facets with two posts on the pole stand upright, with a slope beyond all bounds; they cover nothing.
TEST(BuildTerrain, a_grid_that_reaches_a_pole_has_levels_of_detail) {
  SyntheticGridOptions options;
  options.south = 80;
  options.spacing_latitude = options.spacing_longitude = {300, 1};
  options.columns = options.rows = 121;
  const MemoryFileSystem files = buildInMemory(syntheticGrid(options), {.leaf_cells = 8});
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const Result<std::vector<Node>> nodes = nodesOfLevel(database.value(), 0, 1);
  ASSERT_TRUE(nodes.ok());
  for (const Node& node : nodes.value()) EXPECT_TRUE(std::isfinite(node.geometricError()));
}

}  // namespace
}  // namespace deltaz
