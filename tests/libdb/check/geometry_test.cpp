// Level "geometry" finds nothing in what the builder makes, whatever its shape: two ways of computing agree.
#include <gtest/gtest.h>
#include <string>

#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "tests/libdb/check/code_assets.h"
#include "tests/support/block_changes.h"
#include "tests/support/projected_grid.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

void expectClean(const RawGrid& grid, int leaf_cells, const std::string& what) {
  BuildOptions options;
  options.leaf_cells = leaf_cells;
  const Report report = checkedAt(buildInMemory(grid, options), CheckLevel::kGeometry);
  EXPECT_TRUE(report.groups.empty()) << what << "\n" << listing(report);
  EXPECT_TRUE(report.complete) << what;
  EXPECT_GT(report.leaves_measured, 0u);
}

constexpr VoidPattern kPatterns[] = {VoidPattern::kNone, VoidPattern::kScattered, VoidPattern::kHole,
                                     VoidPattern::kWestHalf, VoidPattern::kSingle};

TEST(CheckGeometry, built_databases_are_clean_at_any_latitude_and_with_any_voids) {
  for (const double south : {-0.3, 43.0, 60.0, 85.0}) {
    for (const VoidPattern voids : kPatterns) {
      for (const int offset : {0, 5}) {
        SyntheticGridOptions shape;
        shape.south = south + offset * 30.0 / 3600;
        shape.west = 12 + 3 * offset * 30.0 / 3600;
        shape.columns = 70 + 2 * offset;
        shape.rows = 61;
        shape.voids = voids;
        expectClean(syntheticGrid(shape), 8,
                    "latitude " + std::to_string(south) + ", voids " +
                        std::to_string(static_cast<int>(voids)) + ", offset " + std::to_string(offset));
      }
    }
  }
}

TEST(CheckGeometry, poles_and_the_antimeridian_are_clean) {
  for (const double south : {-90.0, 89.0}) {
    SyntheticGridOptions shape;
    shape.south = south;
    shape.west = 179.5;
    expectClean(syntheticGrid(shape), 16, "latitude " + std::to_string(south));
  }
}

TEST(CheckGeometry, wide_cells_whose_edges_bow_are_clean) {
  SyntheticGridOptions shape;
  shape.spacing_latitude = shape.spacing_longitude = {600, 1};
  shape.columns = shape.rows = 50;
  shape.south = 45;
  shape.west = 0;
  for (const VoidPattern voids : kPatterns) {
    shape.voids = voids;
    expectClean(syntheticGrid(shape), 8, "voids " + std::to_string(static_cast<int>(voids)));
  }
}

TEST(CheckGeometry, projected_databases_are_clean) {
  for (const VoidPattern voids : kPatterns) {
    expectClean(projectedGrid({.easting = 250000, .northing = 7000000, .voids = voids}), 16,
                "voids " + std::to_string(static_cast<int>(voids)));
  }
}

TEST(CheckGeometry, grids_that_meet_are_clean) {
  const Report report = checkedAt(areaWithInset(), CheckLevel::kGeometry);
  EXPECT_TRUE(report.groups.empty()) << listing(report);
  EXPECT_TRUE(report.complete);
}

// A vertex of the seam put elsewhere: on a post far from the leaf that draws it.
TEST(CheckGeometry, a_seam_that_leaves_the_spheres_of_its_leaves_is_found) {
  MemoryFileSystem files = areaWithInset();
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  Seam seam = database.seams().at(0);
  SeamVertex& vertex = seam.vertices.at(0);
  const PostRange posts =
      database.grid(vertex.side == SeamSide::kUpper ? seam.upper : seam.lower).columnsAt(0);
  vertex.column = vertex.column < (posts.begin + posts.end) / 2 ? posts.end - 1 : posts.begin;
  vertex.to_p1 = vertex.to_p2 = {0, 0};
  vertex.weight1 = vertex.weight2 = 0;
  changeSeam(files, [&](std::vector<std::byte>& bytes) { bytes = encodeSeam(seam); });
  const Report report = checkedAt(files, CheckLevel::kGeometry);
  ASSERT_FALSE(report.groups.empty());
  EXPECT_EQ(report.groups[0].code, IssueCode::kTileSphere) << listing(report);
}

TEST(CheckGeometry, a_sample_says_how_many_leaves_it_took_and_is_the_same_every_time) {
  CheckOptions options;
  options.level = CheckLevel::kGeometry;
  const MemoryFileSystem& files = soundDatabase();
  const std::uint64_t all = checkDatabase(files, kMemoryDatabasePath, options).leaves_measured;
  options.sample_percent = 40;
  const Report first = checkDatabase(files, kMemoryDatabasePath, options);
  options.threads = 1;
  const Report second = checkDatabase(files, kMemoryDatabasePath, options);
  EXPECT_TRUE(first.groups.empty()) << listing(first);
  EXPECT_TRUE(first.complete);
  EXPECT_EQ(first.leaves_measured, second.leaves_measured);
  EXPECT_GT(first.leaves_measured, all / 10);
  EXPECT_LT(first.leaves_measured, all * 8 / 10);
  options.sample_percent = 0;
  EXPECT_EQ(checkDatabase(files, kMemoryDatabasePath, options).leaves_measured, 0u);
}

TEST(CheckGeometry, it_does_not_run_on_what_is_known_to_be_wrong_and_says_so) {
  const Report report =
      byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).valid_posts -= 1; },
                CheckLevel::kGeometry)(soundDatabase());
  ASSERT_EQ(report.groups.size(), 1u) << listing(report);
  EXPECT_EQ(report.groups[0].code, IssueCode::kTileVoids);
  EXPECT_FALSE(report.complete);
  EXPECT_FALSE(report.skipped.empty());
  EXPECT_EQ(report.leaves_measured, 0u);
}

}  // namespace
}  // namespace deltaz
