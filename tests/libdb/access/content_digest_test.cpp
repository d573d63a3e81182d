#include "libdb/access/content_digest.h"

#include <gtest/gtest.h>

#include "tests/support/block_changes.h"
#include "tests/support/database_editor.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

std::string digestOf(const MemoryFileSystem& files) {
  const auto database = Database::open(files, kMemoryDatabasePath);
  if (!database.ok()) return database.error().message();
  const auto digest = contentDigest(database.value());
  return digest.ok() ? toHex(digest.value()) : digest.error().message();
}

SyntheticGridOptions smallGrid() {
  SyntheticGridOptions options;
  options.columns = 40;
  options.rows = 30;
  options.voids = VoidPattern::kScattered;
  return options;
}

MemoryFileSystem smallDatabase(const RawGrid& grid) {
  BuildOptions options;
  options.leaf_cells = 16;
  return buildInMemory(grid, options);
}

TEST(ContentDigest, equal_content_has_an_equal_digest) {
  const RawGrid grid = syntheticGrid(smallGrid());
  const std::string digest = digestOf(smallDatabase(grid));
  EXPECT_EQ(digest.size(), 32u) << digest;
  EXPECT_EQ(digestOf(smallDatabase(grid)), digest);
}

TEST(ContentDigest, one_height_or_one_void_changes_it) {
  RawGrid grid = syntheticGrid(smallGrid());
  const std::string digest = digestOf(smallDatabase(grid));
  const std::size_t post = 17 * 40 + 5;
  grid.valid[post] = 1;
  grid.heights[post] += 1;
  const std::string higher = digestOf(smallDatabase(grid));
  EXPECT_NE(higher, digest);
  grid.valid[post] = 0;
  const std::string void_post = digestOf(smallDatabase(grid));
  EXPECT_NE(void_post, higher);
}

TEST(ContentDigest, provenance_and_generation_do_not_enter) {
  MemoryFileSystem files = smallDatabase(syntheticGrid(smallGrid()));
  const std::string digest = digestOf(files);
  DatabaseEditor editor(files, kMemoryDatabasePath);
  editor.area.tool_version = "another tool";
  editor.area.generation += 5;
  editor.area.options.emplace_back("note", "of no meaning");
  editor.area.grids[0].sources[0].name = "renamed.tif";
  editor.saveArea(true);
  EXPECT_EQ(digestOf(files), digest);
}

TEST(ContentDigest, a_record_or_the_definition_of_normals_enters) {
  for (const bool record : {true, false}) {
    MemoryFileSystem files = smallDatabase(syntheticGrid(smallGrid()));
    const std::string digest = digestOf(files);
    DatabaseEditor editor(files, kMemoryDatabasePath);
    if (record) {
      editor.record(editor.firstOf(1)).geometric_error += 1;
    } else {
      editor.area.grids[0].vertical_datum = "EGM96";
    }
    editor.save();
    EXPECT_NE(digestOf(files), digest) << record;
  }
}

TEST(ContentDigest, damage_is_an_error_and_no_digest) {
  MemoryFileSystem files = smallDatabase(syntheticGrid(smallGrid()));
  DatabaseEditor editor(files, kMemoryDatabasePath);
  // Record numbers that only grow, and a child of its parent's own level.
  editor.record(editor.firstOf(0)).level = 1;
  editor.save();
  const auto database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  EXPECT_FALSE(contentDigest(database.value()).ok());
}

TEST(ContentDigest, how_grids_are_joined_enters) {
  MemoryFileSystem files = areaWithInset();
  const std::string digest = digestOf(files);
  EXPECT_EQ(digest.size(), 32u) << digest;
  EXPECT_EQ(digestOf(areaWithInset()), digest);
  constexpr std::size_t kError = 24;  // offset of a field
  changeSeam(files, [](std::vector<std::byte>& seam) { seam.at(kError) ^= std::byte{1}; });
  EXPECT_NE(digestOf(files), digest);
}

}  // namespace
}  // namespace deltaz
