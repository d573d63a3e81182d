// The n-th operation on the file system fails, for every n until none is left: build, open, check and export
// end in a clean error and leave at the target nothing or everything.
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <string>

#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "libdb/export/export_terrain.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/synthetic_grid.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

const std::string kPath = kMemoryDatabasePath;
const std::string kFolder = parentPath(kMemoryDatabasePath);

RawGrid smallGrid() {
  SyntheticGridOptions options;
  options.columns = 33;
  options.rows = 29;
  options.voids = VoidPattern::kSingle;
  return syntheticGrid(options);
}

BuildOptions oneThread() {
  BuildOptions options;
  options.leaf_cells = 8;
  options.threads = 1;
  return options;
}

const MemoryFileSystem& soundDatabase() {
  static const MemoryFileSystem files = buildInMemory(smallGrid(), oneThread());
  return files;
}

bool isSound(const FileSystem& files, const RawGrid& source) {
  CheckOptions options;
  options.against = &source;
  options.threads = 1;
  const Report report = checkDatabase(files, kPath, options);
  return report.complete && report.count(Severity::kError) == 0;
}

// Calls attempt(faulty file system) with a failing first, second, ... operation, until an attempt needs
// fewer.
void forEveryOperation(const char* what, const FileSystem& files, FaultMode mode,
                       const std::function<void(const FaultFileSystem&)>& attempt) {
  std::uint64_t operation = 1;
  for (; operation < 100000; ++operation) {
    const FaultFileSystem faulty(files, operation, mode);
    attempt(faulty);
    if (testing::Test::HasFailure()) FAIL() << what << ": operation " << operation;
    if (!faulty.failed()) break;
  }
  EXPECT_GT(operation, 5u);
  std::cout << "[  FIGURE  ] " << what << (mode == FaultMode::kOnce ? ", once: " : ", from then on: ")
            << operation - 1 << " operations failed one by one\n";
}

class IoFault : public testing::TestWithParam<FaultMode> {};

TEST_P(IoFault, build_leaves_nothing_or_everything) {
  const RawGrid grid = smallGrid();
  const MemoryFileSystem base;
  ASSERT_TRUE(base.makeDirectory(kFolder).ok());
  MemoryFileSystem files;
  for (std::uint64_t operation = 1;; ++operation) {
    files = base;
    const FaultFileSystem faulty(files, operation, GetParam());
    const auto built = buildTerrain(faulty, grid, kPath, oneThread());
    SCOPED_TRACE("operation " + std::to_string(operation));
    if (!built.ok()) {
      ASSERT_EQ(built.error().kind, ErrorKind::kCannotAccess) << built.error().message();
    }
    const auto type = files.typeOf(kPath);
    ASSERT_TRUE(type.ok());
    if (built.ok() || type.value() != PathType::kAbsent) {
      ASSERT_TRUE(isSound(files, grid));
    }
    if (GetParam() == FaultMode::kOnce) {
      // What the build made and could not use is gone again.
      const auto left = files.list(kFolder).value();
      ASSERT_EQ(left, type.value() == PathType::kAbsent ? std::vector<std::string>{}
                                                        : std::vector<std::string>{baseName(kPath)});
    }
    if (!faulty.failed()) {
      ASSERT_TRUE(built.ok());
      ASSERT_GT(operation, 10u);
      std::cout << "[  FIGURE  ] build: " << operation - 1 << " operations failed one by one\n";
      return;
    }
  }
}

TEST_P(IoFault, overwriting_leaves_the_old_or_the_new_state) {
  const RawGrid old_grid = smallGrid();
  RawGrid new_grid = old_grid;
  for (std::int32_t& height : new_grid.heights) height += 5;
  BuildOptions options = oneThread();
  options.overwrite = true;
  for (std::uint64_t operation = 1;; ++operation) {
    MemoryFileSystem files = soundDatabase();
    const FaultFileSystem faulty(files, operation, GetParam());
    const auto built = buildTerrain(faulty, new_grid, kPath, options);
    SCOPED_TRACE("operation " + std::to_string(operation));
    const bool is_new = isSound(files, new_grid);
    ASSERT_TRUE(is_new || isSound(files, old_grid));
    ASSERT_TRUE(is_new || !built.ok());
    if (!faulty.failed()) {
      ASSERT_TRUE(built.ok() && is_new);
      std::cout << "[  FIGURE  ] overwrite: " << operation - 1 << " operations failed one by one\n";
      return;
    }
  }
}

TEST_P(IoFault, reading_gives_an_error_or_the_right_posts) {
  const auto sound = Database::open(soundDatabase(), kPath);
  ASSERT_TRUE(sound.ok());
  const RawGrid right = readGrid(sound.value(), 0, 0).value();
  forEveryOperation("open and read", soundDatabase(), GetParam(), [&](const FaultFileSystem& faulty) {
    const auto database = Database::open(faulty, kPath);
    if (!database.ok()) {
      EXPECT_EQ(database.error().kind, ErrorKind::kCannotAccess) << database.error().message();
      return;
    }
    const auto grid = readGrid(database.value(), 0, 0);
    if (!grid.ok()) {
      EXPECT_EQ(grid.error().kind, ErrorKind::kCannotAccess) << grid.error().message();
      return;
    }
    EXPECT_EQ(grid.value().heights, right.heights);
    EXPECT_EQ(grid.value().valid, right.valid);
  });
}

TEST_P(IoFault, check_never_calls_valid_what_it_could_not_read) {
  const RawGrid grid = smallGrid();
  CheckOptions options;
  options.against = &grid;
  options.threads = 1;
  forEveryOperation("check", soundDatabase(), GetParam(), [&](const FaultFileSystem& faulty) {
    const Report report = checkDatabase(faulty, kPath, options);
    if (!faulty.failed()) {
      EXPECT_TRUE(report.complete && report.groups.empty());
      return;
    }
    EXPECT_FALSE(report.complete);
    EXPECT_GT(report.count(Severity::kError), 0u);
    ASSERT_TRUE(report.fatal.has_value());
    EXPECT_EQ(report.fatal->kind, ErrorKind::kCannotAccess);
  });
}

TEST_P(IoFault, export_leaves_nothing_or_everything) {
  const TemporaryDirectory folder;
  const std::string target = folder.file("dem.tif");
  forEveryOperation("export", soundDatabase(), GetParam(), [&](const FaultFileSystem& faulty) {
    const auto database = Database::open(faulty, kPath);
    if (!database.ok()) return;
    const Status exported = exportTerrain(database.value(), target, {});
    EXPECT_EQ(exported.ok(), std::filesystem::exists(target));
    std::filesystem::remove(target);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  });
}

INSTANTIATE_TEST_SUITE_P(Modes, IoFault, testing::Values(FaultMode::kOnce, FaultMode::kFromThenOn),
                         [](const auto& information) {
                           return information.param == FaultMode::kOnce ? "once" : "from_then_on";
                         });

}  // namespace
}  // namespace deltaz
