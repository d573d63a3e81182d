// Edits of a database in place: files are added, area.json is swapped, and what nobody names is freed.
#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/build/publication.h"
#include "libdb/export/export_terrain.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

const std::string kPath = kMemoryDatabasePath;

const RawGrid& sampleGrid() {
  static const RawGrid grid = [] {
    SyntheticGridOptions options;
    options.columns = options.rows = 20;
    return syntheticGrid(options);
  }();
  return grid;
}

MemoryFileSystem soundDatabase() {
  return buildInMemory(sampleGrid());
}

// The smallest edit there is: a file of no placements, whose next number tells states apart.
Status setNextInstance(const FileSystem& files, std::uint32_t next) {
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, kPath));
  AreaHeader area = publication.area();
  std::erase_if(area.files, [](const FileReference& file) { return file.role == FileRole::kPlacements; });
  const std::string name = fmt::format("placements-{:06}.dzl", publication.generation());
  DELTAZ_TRY_ASSIGN(ContainerWriter writer,
                    ContainerWriter::create(files, publication.newFilePath(name), ContentKind::kPlacements));
  const std::vector<std::byte> directory = encodePlacementDirectory({0, next, {}});
  DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                    writer.append(BlockType::kPlacementDirectory, directory));
  DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
  area.files.push_back({FileRole::kPlacements, 0, name, identity.length, identity.id});
  return publication.publish(area);
}

// 0 for a database without placements.
std::uint32_t nextInstance(const FileSystem& files) {
  const Result<Database> database = Database::open(files, kPath);
  EXPECT_TRUE(database.ok()) << database.error().message();
  if (!database.ok()) return 0xFFFFFFFF;
  EXPECT_EQ(readGrid(database.value(), 0, 0).value().heights, sampleGrid().heights);
  const PlacementSet* placements = database.value().placements();
  return placements == nullptr ? 0 : placements->directory().next_instance;
}

std::vector<std::string> namesIn(const FileSystem& files) {
  return files.list(kPath).value();
}

TEST(Edit, adds_its_files_and_leaves_the_others_as_they_are) {
  const MemoryFileSystem files = soundDatabase();
  const MemoryFileSystem before = files;
  ASSERT_TRUE(setNextInstance(files, 5).ok());
  EXPECT_EQ(nextInstance(files), 5u);
  EXPECT_EQ(Database::open(files, kPath).value().area().generation, 2u);
  for (const std::string& path : before.paths()) {
    if (baseName(path) == kAreaFileName) continue;
    EXPECT_EQ(files.bytes(path), before.bytes(path)) << path;
  }
  EXPECT_EQ(namesIn(files).size(), namesIn(before).size() + 1);
}

TEST(Edit, leaves_files_of_the_old_state_until_they_are_removed) {
  const MemoryFileSystem files = soundDatabase();
  ASSERT_TRUE(setNextInstance(files, 5).ok());
  const Result<Database> reader = Database::open(files, kPath);
  ASSERT_TRUE(reader.ok());
  ASSERT_TRUE(setNextInstance(files, 6).ok());
  EXPECT_EQ(nextInstance(files), 6u);
  const auto removed = removeUnlisted(files, kPath);
  ASSERT_TRUE(removed.ok()) << removed.error().message();
  EXPECT_EQ(removed.value(), std::vector<std::string>{"placements-000002.dzl"});
  EXPECT_EQ(nextInstance(files), 6u);
  // Whoever has the old state open reads on.
  EXPECT_EQ(readGrid(reader.value(), 0, 0).value().heights, sampleGrid().heights);
  EXPECT_TRUE(removeUnlisted(files, kPath).value().empty());
}

TEST(Edit, removes_only_files_with_names_of_ours) {
  MemoryFileSystem files = soundDatabase();
  for (const char* const name : {"/notes.txt", "/colors-summer.dzc", "/nodes-000009.txt", "/model.dzm"})
    files.setText(kPath + name, "precious");
  for (const char* const name : {"/colors-000009-000.dzc", "/model-000009-003.dzm", "/terrain-000009-000.dzt",
                                 "/nodes-000009.dzn", "/placements-000009.dzl", "/.area.json.new"})
    files.setText(kPath + name, "left by a writer that died");
  const std::vector<std::string> removed = removeUnlisted(files, kPath).value();
  EXPECT_EQ(removed, (std::vector<std::string>{".area.json.new", "colors-000009-000.dzc",
                                               "model-000009-003.dzm", "nodes-000009.dzn",
                                               "placements-000009.dzl", "terrain-000009-000.dzt"}));
  EXPECT_EQ(namesIn(files), (std::vector<std::string>{"area.json", "colors-summer.dzc", "lock", "model.dzm",
                                                      "nodes-000001.dzn", "nodes-000009.txt", "notes.txt",
                                                      "terrain-000001-000.dzt"}));
  EXPECT_EQ(nextInstance(files), 0u);
}

TEST(Edit, one_that_is_given_up_leaves_nothing) {
  const MemoryFileSystem files = soundDatabase();
  const std::vector<std::string> before = files.paths();
  {
    const Result<Publication> publication = Publication::beginEdit(files, kPath);
    ASSERT_TRUE(publication.ok());
  }
  {
    Result<Publication> publication = Publication::beginEdit(files, kPath);
    auto file = files.create(publication.value().newFilePath("colors-000002-000.dzc"));
    ASSERT_TRUE(file.ok());
  }
  EXPECT_EQ(files.paths(), before);
  EXPECT_EQ(nextInstance(files), 0u);
}

TEST(Edit, is_refused_while_another_writer_is_at_work) {
  const MemoryFileSystem files = soundDatabase();
  const MemoryFileSystem before = files;
  const auto held = files.lock(kPath + "/lock");
  ASSERT_TRUE(held.ok());
  const Status edited = setNextInstance(files, 5);
  ASSERT_FALSE(edited.ok());
  EXPECT_EQ(edited.error().kind, ErrorKind::kCannotAccess);
  const auto removed = removeUnlisted(files, kPath);
  ASSERT_FALSE(removed.ok());
  EXPECT_EQ(removed.error().kind, ErrorKind::kCannotAccess);
  EXPECT_EQ(files.paths(), before.paths());
  EXPECT_EQ(nextInstance(files), 0u);
}

TEST(Edit, what_is_no_sound_database_is_not_touched) {
  MemoryFileSystem files;
  files.setText("/folder/precious/notes.txt", "mine");
  for (const bool edit : {true, false}) {
    const Error error = edit ? Publication::beginEdit(files, "/folder/precious").error()
                             : removeUnlisted(files, "/folder/precious").error();
    EXPECT_EQ(error.kind, ErrorKind::kInvalid);
    EXPECT_EQ(files.paths(), std::vector<std::string>{"/folder/precious/notes.txt"}) << "a lock was made";
  }
  files = soundDatabase();
  files.flipBit(kPath + "/area.json", 4000);
  files.setText(kPath + "/terrain-000009-000.dzt", "perhaps needed to repair it");
  const std::vector<std::string> before = files.paths();
  EXPECT_EQ(Publication::beginEdit(files, kPath).error().kind, ErrorKind::kInvalid);
  EXPECT_EQ(removeUnlisted(files, kPath).error().kind, ErrorKind::kInvalid);
  EXPECT_EQ(files.paths(), before);
}

TEST(Edit, what_could_not_be_opened_again_is_not_published) {
  const MemoryFileSystem files = soundDatabase();
  Result<Publication> publication = Publication::beginEdit(files, kPath);
  ASSERT_TRUE(publication.ok());
  AreaHeader area = publication.value().area();
  area.color_maps = {{"no name", "image", {}, {}}};
  EXPECT_FALSE(publication.value().publish(area).ok());
  EXPECT_EQ(nextInstance(files), 0u);
}

class FailingEdit : public testing::TestWithParam<FaultMode> {};

TEST_P(FailingEdit, leaves_the_old_or_the_new_state_and_the_next_one_works) {
  MemoryFileSystem base = soundDatabase();
  ASSERT_TRUE(setNextInstance(base, 5).ok());
  for (std::uint64_t operation = 1;; ++operation) {
    SCOPED_TRACE("operation " + std::to_string(operation));
    const MemoryFileSystem files = base;
    const FaultFileSystem faulty(files, operation, GetParam());
    const Status edited = setNextInstance(faulty, 6);
    const std::uint32_t state = nextInstance(files);
    ASSERT_TRUE(state == 6 || (state == 5 && !edited.ok()));
    ASSERT_TRUE(edited.ok() || edited.error().kind == ErrorKind::kCannotAccess);
    ASSERT_TRUE(setNextInstance(files, 7).ok());
    ASSERT_EQ(nextInstance(files), 7u);
    ASSERT_TRUE(removeUnlisted(files, kPath).ok());
    ASSERT_EQ(namesIn(files).size(), 5u) << "area.json, lock, nodes, terrain, placements";
    if (faulty.failed()) continue;
    ASSERT_TRUE(edited.ok());
    ASSERT_GT(operation, 15u);
    return;
  }
}

TEST_P(FailingEdit, removing_never_takes_a_listed_file) {
  MemoryFileSystem base = soundDatabase();
  for (const std::uint32_t next : {5u, 6u, 7u}) ASSERT_TRUE(setNextInstance(base, next).ok());
  for (std::uint64_t operation = 1;; ++operation) {
    SCOPED_TRACE("operation " + std::to_string(operation));
    const MemoryFileSystem files = base;
    const FaultFileSystem faulty(files, operation, GetParam());
    const auto removed = removeUnlisted(faulty, kPath);
    ASSERT_EQ(nextInstance(files), 7u);
    ASSERT_TRUE(removeUnlisted(files, kPath).ok());
    ASSERT_EQ(namesIn(files).size(), 5u);
    if (faulty.failed()) continue;
    ASSERT_TRUE(removed.ok());
    ASSERT_GT(operation, 5u);
    return;
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, FailingEdit, testing::Values(FaultMode::kOnce, FaultMode::kFromThenOn),
                         [](const auto& information) {
                           return information.param == FaultMode::kOnce ? "once" : "from_then_on";
                         });

}  // namespace
}  // namespace deltaz
