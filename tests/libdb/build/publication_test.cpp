#include "libdb/build/publication.h"

#include <algorithm>
#include <atomic>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/build/build_terrain.h"
#include "libdb/export/export_terrain.h"
#include "tests/support/synthetic_grid.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

RawGrid gridOfSeed(std::uint32_t seed) {
  SyntheticGridOptions options;
  options.seed = seed;
  options.columns = options.rows = 40;
  return syntheticGrid(options);
}

std::int32_t firstHeight(const FileSystem& files) {
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  EXPECT_TRUE(database.ok()) << database.error().message();
  const Result<std::vector<Node>> leaves = nodesOfLevel(database.value(), 0, 0);
  return database.value().terrain(leaves.value().front()).value().height(0, 0);
}

TEST(Publication, an_existing_target_is_kept_unless_overwriting) {
  MemoryFileSystem files = buildInMemory(gridOfSeed(1));
  const Result<BuildSummary> refused = buildTerrain(files, gridOfSeed(2), kMemoryDatabasePath, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(firstHeight(files), gridOfSeed(1).height(0, 0));

  ASSERT_TRUE(buildTerrain(files, gridOfSeed(2), kMemoryDatabasePath, {.overwrite = true}).ok());
  EXPECT_EQ(firstHeight(files), gridOfSeed(2).height(0, 0));
  EXPECT_EQ(Database::open(files, kMemoryDatabasePath).value().area().generation, 2u);
  // Nothing of the old state is left behind.
  EXPECT_EQ(files.list(kMemoryDatabasePath).value().size(), 4u);
}

TEST(Publication, a_reader_that_opened_before_an_overwrite_keeps_its_state) {
  MemoryFileSystem files = buildInMemory(gridOfSeed(1));
  Result<Database> old_state = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(old_state.ok());
  ASSERT_TRUE(buildTerrain(files, gridOfSeed(2), kMemoryDatabasePath, {.overwrite = true}).ok());
  const Result<std::vector<Node>> leaves = nodesOfLevel(old_state.value(), 0, 0);
  ASSERT_TRUE(leaves.ok()) << leaves.error().message();
  EXPECT_EQ(old_state.value().terrain(leaves.value().front()).value().height(0, 0),
            gridOfSeed(1).height(0, 0));
}

// Readers that open, and read to the end, while the database is replaced again and again: each sees one
// state.
TEST(Publication, readers_see_one_state_while_it_is_replaced) {
  const TemporaryDirectory folder;
  const std::string target = folder.file("area.dz");
  const RawGrid even = gridOfSeed(1), odd = gridOfSeed(2);
  ASSERT_TRUE(buildTerrain(localFileSystem(), even, target, {}).ok());
  std::atomic<bool> done = false;
  std::atomic<int> opened = 0;
  std::vector<std::thread> readers;
  for (int k = 0; k < 4; ++k) {
    readers.emplace_back([&] {
      while (!done) {
        Result<Database> database = Database::open(localFileSystem(), target);
        ASSERT_TRUE(database.ok()) << database.error().message();
        const Result<RawGrid> grid = readGrid(database.value(), 0, 0);
        ASSERT_TRUE(grid.ok()) << grid.error().message();
        ASSERT_TRUE(grid.value().heights == even.heights || grid.value().heights == odd.heights);
        ++opened;
      }
    });
  }
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(
        buildTerrain(localFileSystem(), k % 2 == 0 ? odd : even, target, {.overwrite = true, .threads = 1})
            .ok());
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_GT(opened, 4);
}

TEST(Publication, what_is_not_a_database_is_never_overwritten) {
  MemoryFileSystem files;
  ASSERT_TRUE(files.makeDirectory("/folder").ok());
  ASSERT_TRUE(files.makeDirectory(kMemoryDatabasePath).ok());
  files.setBytes(kMemoryDatabasePath + "/precious.txt", {std::byte{1}});
  const Result<BuildSummary> refused =
      buildTerrain(files, gridOfSeed(1), kMemoryDatabasePath, {.overwrite = true});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(files.list(kMemoryDatabasePath).value(), std::vector<std::string>{"precious.txt"});
  files.setBytes(kMemoryDatabasePath + "/area.json", {std::byte{'{'}, std::byte{'}'}});
  EXPECT_FALSE(buildTerrain(files, gridOfSeed(1), kMemoryDatabasePath, {.overwrite = true}).ok());
}

TEST(Publication, an_overwrite_removes_what_dead_writers_left_and_nothing_else) {
  MemoryFileSystem files = buildInMemory(gridOfSeed(1));
  files.setBytes(kMemoryDatabasePath + "/terrain-000007-000.dzt", {std::byte{1}});
  files.setBytes(kMemoryDatabasePath + "/notes.txt", {std::byte{1}});
  ASSERT_TRUE(buildTerrain(files, gridOfSeed(2), kMemoryDatabasePath, {.overwrite = true}).ok());
  EXPECT_EQ(files.list(kMemoryDatabasePath).value(),
            (std::vector<std::string>{"area.json", "lock", "nodes-000008.dzn", "notes.txt",
                                      "terrain-000008-000.dzt"}));
}

TEST(Publication, a_damaged_database_may_be_overwritten) {
  MemoryFileSystem files = buildInMemory(gridOfSeed(1));
  auto area = files.bytes(kMemoryDatabasePath + "/area.json");
  area[area.size() / 2] ^= std::byte{1};
  files.setBytes(kMemoryDatabasePath + "/area.json", area);
  ASSERT_TRUE(buildTerrain(files, gridOfSeed(2), kMemoryDatabasePath, {.overwrite = true}).ok());
  EXPECT_EQ(firstHeight(files), gridOfSeed(2).height(0, 0));
}

TEST(Publication, a_second_writer_is_turned_away) {
  MemoryFileSystem files = buildInMemory(gridOfSeed(1));
  const auto held = files.lock(kMemoryDatabasePath + "/lock");
  ASSERT_TRUE(held.ok());
  const Result<BuildSummary> refused =
      buildTerrain(files, gridOfSeed(2), kMemoryDatabasePath, {.overwrite = true});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kCannotAccess);
}

TEST(Publication, left_over_folders_of_dead_builds_are_swept_and_those_of_living_ones_kept) {
  MemoryFileSystem files;
  ASSERT_TRUE(files.makeDirectory("/folder").ok());
  for (const char* const name : {"/folder/.area.dz.tmp-1", "/folder/.area.dz.tmp-2"}) {
    ASSERT_TRUE(files.makeDirectory(name).ok());
    files.setBytes(std::string(name) + "/nodes-000001.dzn", {std::byte{1}});
  }
  const auto living = files.lock("/folder/.area.dz.tmp-2/lock");
  ASSERT_TRUE(living.ok());
  ASSERT_TRUE(buildTerrain(files, gridOfSeed(1), kMemoryDatabasePath, {}).ok());
  EXPECT_EQ(files.list("/folder").value(), (std::vector<std::string>{".area.dz.tmp-2", "area.dz"}));
}

TEST(Publication, a_missing_folder_is_named) {
  const MemoryFileSystem files;
  const Result<BuildSummary> refused = buildTerrain(files, gridOfSeed(1), "/nowhere/area.dz", {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kCannotAccess);
  EXPECT_NE(refused.error().message().find("/nowhere"), std::string::npos);
}

}  // namespace
}  // namespace deltaz
