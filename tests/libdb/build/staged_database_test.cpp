#include "libdb/build/staged_database.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "libdb/access/database.h"
#include "libdb/build/build_terrain.h"
#include "libdb/build/publication.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

constexpr const char* kTarget = "maps/a.dz";

RawGrid gridOfSeed(std::uint32_t seed) {
  SyntheticGridOptions options;
  options.seed = seed;
  options.columns = options.rows = 20;
  return syntheticGrid(options);
}

MemoryFileSystem emptyFolder() {
  MemoryFileSystem files;
  EXPECT_TRUE(files.makeDirectory("maps").ok());
  return files;
}

// A build in two steps: terrain, then an edit that changes a provenance text.
Status buildInSteps(const FileSystem& files, std::uint32_t seed, bool overwrite) {
  DELTAZ_TRY_ASSIGN(StagedDatabase staged, StagedDatabase::begin(files, kTarget, overwrite));
  DELTAZ_TRY_ASSIGN([[maybe_unused]] const BuildSummary summary,
                    buildTerrain(files, gridOfSeed(seed), staged.path(), {}));
  {
    DELTAZ_TRY_ASSIGN(Publication edit, Publication::beginEdit(files, staged.path()));
    AreaHeader area = edit.area();
    // A file that no one names, as an edit leaves that replaces another's.
    DELTAZ_TRY_ASSIGN(const std::unique_ptr<WritableFile> left,
                      files.create(joinPath(staged.path(), "colors-000001-000.dzc")));
    DELTAZ_TRY(left->close());
    area.options.emplace_back("edited", std::to_string(seed));
    DELTAZ_TRY(edit.publish(area));
  }
  return staged.publish();
}

// Which seed's database stands at the target; 0 for none.
std::uint32_t seedOf(const FileSystem& files) {
  if (files.typeOf(kTarget).value() == PathType::kAbsent) return 0;
  const Result<Database> database = Database::open(files, kTarget);
  EXPECT_TRUE(database.ok()) << database.error().message();
  if (!database.ok()) return 0;
  const auto& options = database.value().area().options;
  const auto edited = std::find_if(options.begin(), options.end(),
                                   [](const auto& option) { return option.first == "edited"; });
  EXPECT_NE(edited, options.end()) << "the steps' first state is seen";
  const auto seed = static_cast<std::uint32_t>(std::stoul(edited->second));
  const Result<std::vector<Node>> leaves = nodesOfLevel(database.value(), 0, 0);
  EXPECT_EQ(database.value().terrain(leaves.value().front()).value().height(0, 0),
            gridOfSeed(seed).height(0, 0));
  return seed;
}

TEST(StagedDatabase, several_steps_appear_at_once_and_nothing_else_stays) {
  const MemoryFileSystem files = emptyFolder();
  const Status built = buildInSteps(files, 1, false);
  ASSERT_TRUE(built.ok()) << built.error().message();
  EXPECT_EQ(seedOf(files), 1u);
  EXPECT_EQ(files.list("maps").value(), std::vector<std::string>{"a.dz"});
  EXPECT_EQ(files.list(kTarget).value().size(),
            Database::open(files, kTarget).value().area().files.size() + 2);
}

TEST(StagedDatabase, an_existing_target_is_kept_unless_overwriting) {
  const MemoryFileSystem files = emptyFolder();
  ASSERT_TRUE(buildInSteps(files, 1, false).ok());
  const Status refused = buildInSteps(files, 2, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(seedOf(files), 1u);
  const Status replaced = buildInSteps(files, 2, true);
  ASSERT_TRUE(replaced.ok()) << replaced.error().message();
  EXPECT_EQ(seedOf(files), 2u);
  EXPECT_EQ(files.list("maps").value(), std::vector<std::string>{"a.dz"});
  // Only what area.json lists, itself and the lock.
  EXPECT_EQ(files.list(kTarget).value().size(),
            Database::open(files, kTarget).value().area().files.size() + 2);
}

TEST(StagedDatabase, a_reader_of_the_old_state_keeps_it) {
  const MemoryFileSystem files = emptyFolder();
  ASSERT_TRUE(buildInSteps(files, 1, false).ok());
  const Result<Database> before = Database::open(files, kTarget);
  ASSERT_TRUE(buildInSteps(files, 2, true).ok());
  const Result<std::vector<Node>> leaves = nodesOfLevel(before.value(), 0, 0);
  ASSERT_TRUE(leaves.ok()) << leaves.error().message();
  EXPECT_EQ(before.value().terrain(leaves.value().front()).value().height(0, 0), gridOfSeed(1).height(0, 0));
}

TEST(StagedDatabase, whatever_fails_leaves_the_old_state_or_the_new_one) {
  for (const bool exists : {false, true}) {
    MemoryFileSystem before = emptyFolder();
    if (exists) {
      ASSERT_TRUE(buildInSteps(before, 1, false).ok());
    }
    const std::uint32_t old_seed = exists ? 1 : 0;
    std::uint64_t failing = 1;
    for (bool failed = true; failed; ++failing) {
      const MemoryFileSystem files = before;
      const FaultFileSystem faulty(files, failing, FaultMode::kFromThenOn);
      const Status built = buildInSteps(faulty, 2, exists);
      failed = faulty.failed();
      const std::uint32_t seed = seedOf(files);
      EXPECT_TRUE(seed == 2 || (seed == old_seed && !built.ok())) << "operation " << failing;
      // And the next one works.
      const Status again = buildInSteps(files, 2, seed != 0);
      EXPECT_TRUE(again.ok()) << "after operation " << failing << ": " << again.error().message();
      EXPECT_EQ(files.list("maps").value(), std::vector<std::string>{"a.dz"}) << "operation " << failing;
    }
    EXPECT_GT(failing, 30u);
  }
}

}  // namespace
}  // namespace deltaz
