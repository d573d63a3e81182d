// A database of every released format version is kept for ever in tests/golden, and this version reads all of
// them.
#include <gtest/gtest.h>

#include "libdb/access/content_digest.h"
#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "libdb/export/export_terrain.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// What the golden databases hold.
RawGrid goldenGrid() {
  SyntheticGridOptions options;
  options.columns = 40;
  options.rows = 30;
  options.voids = VoidPattern::kHole;
  return syntheticGrid(options);
}

// By container version.
class Golden : public testing::TestWithParam<const char*> {
 protected:
  std::string path() const { return std::string(DELTAZ_GOLDEN "/") + GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Versions, Golden, testing::Values("version_1.dz", "version_2.dz"),
                         [](const auto& version) { return std::string(version.param).substr(0, 9); });

TEST_P(Golden, reads_post_for_post) {
  Result<Database> database = Database::open(localFileSystem(), path());
  ASSERT_TRUE(database.ok()) << database.error().message();
  const Result<RawGrid> grid = readGrid(database.value(), 0, 0);
  ASSERT_TRUE(grid.ok()) << grid.error().message();
  const RawGrid expected = goldenGrid();
  ASSERT_EQ(grid.value().heights.size(), expected.heights.size());
  for (std::int64_t row = 0; row < expected.header.y_axis.count; ++row) {
    for (std::int64_t column = 0; column < expected.header.x_axis.count; ++column) {
      ASSERT_EQ(grid.value().isValid(column, row), expected.isValid(column, row));
      if (expected.isValid(column, row)) {
        ASSERT_EQ(grid.value().height(column, row), expected.height(column, row));
      }
    }
  }
}

TEST_P(Golden, is_valid) {
  const RawGrid source = goldenGrid();
  CheckOptions options;
  options.against = &source;
  const Report report = checkDatabase(localFileSystem(), path(), options);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.count(Severity::kError), 0u);
}

// Errors, bounds, normals' definition and topology enter the digest: a change in any of them is a change of
// what databases say, and must be meant.
TEST_P(Golden, says_the_same_as_a_fresh_build) {
  Result<Database> golden = Database::open(localFileSystem(), path());
  ASSERT_TRUE(golden.ok());
  const MemoryFileSystem files = buildInMemory(goldenGrid(), {.leaf_cells = 8});
  Result<Database> fresh = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(fresh.ok());
  const Result<Hash128> golden_digest = contentDigest(golden.value());
  const Result<Hash128> fresh_digest = contentDigest(fresh.value());
  ASSERT_TRUE(golden_digest.ok() && fresh_digest.ok());
  EXPECT_EQ(toHex(golden_digest.value()), toHex(fresh_digest.value()));
}

// The bytes themselves, but for what the compressor's version decides.
TEST_P(Golden, node_records_are_those_of_a_fresh_build) {
  Result<Database> golden = Database::open(localFileSystem(), path());
  ASSERT_TRUE(golden.ok());
  const MemoryFileSystem files = buildInMemory(goldenGrid(), {.leaf_cells = 8});
  Result<Database> fresh = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(fresh.ok());
  ASSERT_EQ(golden.value().area().node_count, fresh.value().area().node_count);
  for (std::uint32_t number = 1; number <= golden.value().area().node_count; ++number) {
    EXPECT_EQ(golden.value().record(number).value(), fresh.value().record(number).value()) << number;
  }
}

// Bytes of the present version; terrain is left out, since zstd's version has a say in it.
TEST(GoldenBytes, the_node_file_of_version_2_is_that_of_a_fresh_build) {
  const std::string path = DELTAZ_GOLDEN "/version_2.dz";
  const Result<Database> golden = Database::open(localFileSystem(), path);
  ASSERT_TRUE(golden.ok()) << golden.error().message();
  const MemoryFileSystem files = buildInMemory(goldenGrid(), {.leaf_cells = 8});
  const Result<Database> fresh = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(fresh.ok());
  const ContainerReader &a = golden.value().nodeFile(), &b = fresh.value().nodeFile();
  EXPECT_EQ(a.identity().length, b.identity().length);
  EXPECT_EQ(toHex(a.identity().id), toHex(b.identity().id));
  ASSERT_EQ(a.blockCount(), b.blockCount());
  for (std::uint32_t page = 0; page < a.blockCount(); ++page) {
    EXPECT_EQ(a.read(page, BlockType::kPackedNodePage).value(),
              b.read(page, BlockType::kPackedNodePage).value());
  }
}

}  // namespace
}  // namespace deltaz
