#include "libdb/access/content_digest.h"

#include <gtest/gtest.h>

#include "libdb/build/build_terrain.h"
#include "tests/support/container_surgery.h"
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

// Two grids, one lying in the other, with the last bit of the seam's stored error as it is or flipped.
MemoryFileSystem areaWithSeam(bool flipped) {
  SyntheticGridOptions inset;
  inset.south += 0.05;
  inset.west += 0.05;
  inset.spacing_latitude = inset.spacing_longitude = {15, 1};
  inset.columns = inset.rows = 25;
  const std::vector<RawGrid> grids = {syntheticGrid(inset), syntheticGrid(smallGrid())};
  MemoryFileSystem files;
  EXPECT_TRUE(files.makeDirectory("/folder").ok());
  EXPECT_TRUE(buildTerrain(files, grids, kMemoryDatabasePath, {.leaf_cells = 16}).ok());
  const std::string area_path = kMemoryDatabasePath + "/" + std::string(kAreaFileName);
  AreaHeader area = parseArea(files.text(area_path), area_path).value();
  for (FileReference& file : area.files) {
    if (file.role != FileRole::kSeams) continue;
    const std::string path = kMemoryDatabasePath + "/" + file.name;
    std::vector<std::byte> seam = payloadOf(files.bytes(path), 0);
    constexpr std::size_t kError = 24;
    if (flipped) seam.at(kError) ^= std::byte{1};
    files.setBytes(path, makeContainer(ContentKind::kSeams, BlockType::kSeam, {seam}));
    const FileIdentity identity = identityOf(files.bytes(path));
    file.length = identity.length;
    file.id = identity.id;
  }
  files.setText(area_path, serializeArea(area));
  return files;
}

TEST(ContentDigest, how_grids_are_joined_enters) {
  const std::string digest = digestOf(areaWithSeam(false));
  EXPECT_EQ(digest.size(), 32u) << digest;
  EXPECT_NE(digestOf(areaWithSeam(true)), digest);
}

}  // namespace
}  // namespace deltaz
