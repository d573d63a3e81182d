#include "libdb/access/database.h"

#include <gtest/gtest.h>

#include "tests/support/database_editor.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

TEST(Database, hands_out_exactly_what_was_built) {
  SyntheticGridOptions options;
  options.voids = VoidPattern::kHole;
  const RawGrid grid = syntheticGrid(options);
  const MemoryFileSystem files = buildInMemory(grid);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  const GridHeader& header = database.value().area().grids[0];
  for (int level = 0; level < header.level_count; ++level) {
    const Result<std::vector<Node>> nodes = nodesOfLevel(database.value(), 0, level);
    ASSERT_TRUE(nodes.ok());
    for (const Node& node : nodes.value()) {
      const Result<TerrainTile> tile = database.value().terrain(node);
      ASSERT_TRUE(tile.ok()) << tile.error().message();
      const std::int64_t step = std::int64_t{1} << level;
      for (int j = -1; j <= tile.value().rows; ++j) {
        for (int i = -1; i <= tile.value().columns; ++i) {
          const std::int64_t column = (tile.value().first_column + i) * step - header.x_axis.first;
          const std::int64_t row = (tile.value().first_row + j) * step - header.y_axis.first;
          const bool inside =
              column >= 0 && column < header.x_axis.count && row >= 0 && row < header.y_axis.count;
          ASSERT_EQ(tile.value().isValid(i, j), inside && grid.isValid(column, row));
          if (tile.value().isValid(i, j)) {
            ASSERT_EQ(tile.value().height(i, j), grid.height(column, row));
          }
        }
      }
    }
  }
}

TEST(Database, reads_only_what_is_asked_for) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const std::uint64_t after_open = database.value().bytesRead();
  std::uint64_t length = 0;
  for (const FileReference& file : database.value().area().files) length += file.length;
  EXPECT_LT(after_open, length / 2);
  ASSERT_TRUE(database.value().root().ok());
  const std::uint64_t after_root = database.value().bytesRead();
  EXPECT_GT(after_root, after_open);
  ASSERT_TRUE(database.value().root().ok());
  EXPECT_EQ(database.value().bytesRead(), after_root) << "a page is read once";
}

TEST(Database, what_is_no_database_is_refused_by_name) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  EXPECT_EQ(Database::open(files, "/folder/none.dz").error().kind, ErrorKind::kCannotAccess);
  EXPECT_EQ(Database::open(files, "/folder").error().kind, ErrorKind::kInvalid);
  EXPECT_EQ(Database::open(files, kMemoryDatabasePath + "/area.json").error().kind, ErrorKind::kInvalid);
}

TEST(Database, a_missing_or_exchanged_file_is_found_on_opening) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  SyntheticGridOptions other_options;
  other_options.seed = 2;
  MemoryFileSystem other = buildInMemory(syntheticGrid(other_options));
  const std::string terrain = DatabaseEditor(files, kMemoryDatabasePath).terrainPath();
  MemoryFileSystem exchanged = files;
  exchanged.setBytes(terrain, other.bytes(terrain));
  EXPECT_EQ(Database::open(exchanged, kMemoryDatabasePath).error().code, IssueCode::kManFileMismatch);
  ASSERT_TRUE(files.removeFile(terrain).ok());
  EXPECT_EQ(Database::open(files, kMemoryDatabasePath).error().code, IssueCode::kIoMissingFile);
}

TEST(Database, a_record_count_at_the_integer_limit_is_refused) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  DatabaseEditor editor(files, kMemoryDatabasePath);
  editor.area.node_count = 0xFFFFFFFF;
  editor.saveArea();
  EXPECT_EQ(Database::open(files, kMemoryDatabasePath).error().code, IssueCode::kManField);
}

TEST(Database, children_that_lead_in_circles_are_refused) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  DatabaseEditor editor(files, kMemoryDatabasePath);
  editor.record(3).sibling = 3;
  editor.save();
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const Result<std::vector<Node>> nodes = nodesOfLevel(database.value(), 0, 0);
  ASSERT_FALSE(nodes.ok());
  EXPECT_EQ(nodes.error().code, IssueCode::kRefCycle);
}

}  // namespace
}  // namespace deltaz
