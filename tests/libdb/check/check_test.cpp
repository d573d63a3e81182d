#include "libdb/check/check.h"

#include <gtest/gtest.h>
#include <new>
#include <string>

#include "libdb/access/database.h"
#include "tests/support/container_surgery.h"
#include "tests/support/database_editor.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

const std::string kPath = kMemoryDatabasePath;

BuildOptions leaves(int cells) {
  BuildOptions options;
  options.leaf_cells = cells;
  return options;
}

Report check(const FileSystem& files, const RawGrid* against = nullptr, int threads = 0) {
  CheckOptions options;
  options.against = against;
  options.against_name = "source.tif";
  options.threads = threads;
  return checkDatabase(files, kPath, options);
}

std::string textOf(const Report& report) {
  std::string text = report.complete ? "complete\n" : "incomplete\n";
  for (const IssueGroup& group : report.groups) {
    text += std::string(issueCodeName(group.code)) + " " + std::to_string(group.count) + "\n";
    for (const Issue& issue : group.first) {
      text += "  " + issue.where.file + " block " + std::to_string(issue.where.block.value_or(0)) + " node " +
              std::to_string(issue.where.node.value_or(0)) + ": " + issue.message + "\n";
    }
    if (group.worst) text += "  worst: " + group.worst->message + "\n";
  }
  for (const std::string& skipped : report.skipped) text += "skipped: " + skipped + "\n";
  return text;
}

const IssueGroup* groupOf(const Report& report, IssueCode code) {
  for (const IssueGroup& group : report.groups) {
    if (group.code == code) return &group;
  }
  return nullptr;
}

TEST(CheckDatabase, sound_databases_of_many_shapes_are_clean) {
  for (const VoidPattern voids :
       {VoidPattern::kNone, VoidPattern::kScattered, VoidPattern::kHole, VoidPattern::kWestHalf}) {
    for (const int cells : {8, 16, 64}) {
      for (const int offset : {0, 1, 7, 13}) {
        SyntheticGridOptions shape;
        shape.voids = voids;
        shape.columns = 60 + 3 * offset;
        shape.rows = 71 - 4 * offset;
        shape.west = -80 + offset * 30.0 / 3600;
        shape.south = -10 - offset * 30.0 / 3600;
        const RawGrid grid = syntheticGrid(shape);
        const Report report = check(buildInMemory(grid, leaves(cells)), &grid);
        EXPECT_TRUE(report.groups.empty()) << textOf(report) << "leaf " << cells << " offset " << offset;
        EXPECT_TRUE(report.complete);
        EXPECT_EQ(report.posts_compared, static_cast<std::uint64_t>(shape.columns * shape.rows));
        EXPECT_GT(report.nodes_checked, 2u);
        EXPECT_GT(report.blocks_checked, 2u);
      }
    }
  }
}

TEST(CheckDatabase, smallest_area_is_clean) {
  SyntheticGridOptions shape;
  shape.columns = shape.rows = 2;
  const RawGrid grid = syntheticGrid(shape);
  const Report report = check(buildInMemory(grid), &grid);
  EXPECT_TRUE(report.groups.empty()) << textOf(report);
  EXPECT_EQ(report.posts_compared, 4u);
}

TEST(CheckDatabase, area_across_the_antimeridian_is_clean) {
  SyntheticGridOptions shape;
  shape.west = 179.75;
  const RawGrid grid = syntheticGrid(shape);
  const Report report = check(buildInMemory(grid), &grid);
  EXPECT_TRUE(report.groups.empty()) << textOf(report);
}

TEST(CheckDatabase, area_at_the_pole_is_clean) {
  SyntheticGridOptions shape;
  shape.south = 89;
  const RawGrid grid = syntheticGrid(shape);
  const Report report = check(buildInMemory(grid), &grid);
  EXPECT_TRUE(report.groups.empty()) << textOf(report);
}

TEST(CheckDatabase, one_post_changed_by_a_metre_is_one_issue_at_its_place) {
  SyntheticGridOptions shape;
  const RawGrid grid = syntheticGrid(shape);
  const MemoryFileSystem files = buildInMemory(grid, leaves(16));
  // In the middle of a leaf, on a border of two, on a corner of four, at the area's corners.
  const std::int64_t first_column = grid.header.x_axis.first, first_row = grid.header.y_axis.first;
  const std::int64_t border = (16 - first_column % 16) % 16 + 16, corner = (16 - first_row % 16) % 16 + 16;
  for (const auto& [column, row] : {std::pair{border + 5, corner + 7},
                                    {border, corner + 3},
                                    {border, corner},
                                    {std::int64_t{0}, std::int64_t{0}},
                                    {std::int64_t{120}, std::int64_t{120}}}) {
    RawGrid changed = grid;
    changed.heights.at(static_cast<std::size_t>(row * 121 + column)) += 1;
    const Report report = check(files, &changed);
    ASSERT_EQ(report.groups.size(), 1u) << textOf(report);
    EXPECT_EQ(report.groups[0].code, IssueCode::kSrcHeight);
    EXPECT_EQ(report.groups[0].count, 1u) << textOf(report);
    const Issue& issue = report.groups[0].first.at(0);
    EXPECT_EQ(issue.magnitude, 1.0);
    EXPECT_NEAR(issue.where.longitude.value(), -80 + static_cast<double>(column) * 30 / 3600, 1e-9);
    EXPECT_NEAR(issue.where.latitude.value(), 43 + static_cast<double>(row) * 30 / 3600, 1e-9);
  }
}

TEST(CheckDatabase, every_post_different_is_counted_exactly_and_the_worst_is_named) {
  const RawGrid grid = syntheticGrid();
  RawGrid changed = grid;
  for (std::int32_t& height : changed.heights) height += 2;
  changed.heights.at(700) += 40;
  const Report report = check(buildInMemory(grid, leaves(16)), &changed);
  const IssueGroup* group = groupOf(report, IssueCode::kSrcHeight);
  ASSERT_NE(group, nullptr);
  EXPECT_EQ(group->count, 121u * 121u);
  EXPECT_EQ(group->first.size(), kKeptIssues);
  EXPECT_EQ(group->worst->magnitude, 42.0);
}

TEST(CheckDatabase, report_does_not_depend_on_threads) {
  const RawGrid grid = syntheticGrid();
  MemoryFileSystem files = buildInMemory(grid, leaves(8));
  DatabaseEditor editor(files, kPath);
  for (std::uint32_t number = 5; number < editor.records.size(); number += 3) {
    TerrainBlock block = editor.block(number);
    for (std::size_t i = 0; i < block.heights.size(); i += 7) block.heights[i] += 3;
    editor.setBlock(number, block);
  }
  editor.save();
  const std::string one = textOf(check(files, &grid, 1));
  EXPECT_NE(one.find("HGT_RING"), std::string::npos);
  EXPECT_EQ(one, textOf(check(files, &grid, 2)));
  EXPECT_EQ(one, textOf(check(files, &grid, 7)));
}

TEST(CheckDatabase, damaged_block_is_named_once) {
  MemoryFileSystem files = buildInMemory(syntheticGrid(), leaves(16));
  const DatabaseEditor editor(files, kPath);
  FileBytes& terrain = files.mutableBytes(editor.terrainPath());
  terrain.at(entryOf(terrain, 4).offset) ^= std::byte{1};
  const Report report = check(files);
  ASSERT_EQ(report.groups.size(), 1u) << textOf(report);
  EXPECT_EQ(report.groups[0].code, IssueCode::kSumBlock);
  EXPECT_EQ(report.groups[0].count, 1u);
  EXPECT_EQ(report.groups[0].first[0].where.block, 4u);
  EXPECT_EQ(report.groups[0].first[0].where.file, baseName(editor.terrainPath()));
}

TEST(CheckDatabase, damaged_node_page_is_named_once_and_the_rest_said_to_be_unchecked) {
  MemoryFileSystem files = buildInMemory(syntheticGrid(), leaves(8));
  const DatabaseEditor editor(files, kPath);
  FileBytes& nodes = files.mutableBytes(editor.nodePath());
  nodes.at(entryOf(nodes, 1).offset + 5) ^= std::byte{1};
  const Report report = check(files);
  ASSERT_EQ(report.groups.size(), 1u) << textOf(report);
  EXPECT_EQ(report.groups[0].code, IssueCode::kSumBlock);
  EXPECT_EQ(report.groups[0].count, 1u);
  EXPECT_FALSE(report.complete);
  EXPECT_FALSE(report.skipped.empty());
}

TEST(CheckDatabase, missing_folder_cannot_be_accessed) {
  const Report report = check(MemoryFileSystem());
  ASSERT_TRUE(report.fatal.has_value());
  EXPECT_EQ(report.fatal->kind, ErrorKind::kCannotAccess);
  EXPECT_FALSE(report.complete);
  EXPECT_EQ(report.count(Severity::kError), 1u);
}

TEST(CheckDatabase, folder_without_area_is_not_a_database) {
  MemoryFileSystem files;
  files.setText(kPath + "/readme.txt", "hello");
  const Report report = check(files);
  ASSERT_TRUE(report.fatal.has_value());
  EXPECT_EQ(report.fatal->kind, ErrorKind::kInvalid);
  EXPECT_FALSE(report.complete);
}

TEST(CheckDatabase, newer_version_leaves_the_verdict_open) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  const std::string area = kPath + "/area.json";
  std::string text = files.text(area);
  text.replace(text.find("\"version\": 1"), 12, "\"version\": 2");
  files.setText(area, sealAreaText(text));
  const Report report = check(files);
  ASSERT_TRUE(report.fatal.has_value());
  EXPECT_EQ(report.fatal->kind, ErrorKind::kNewerFormat);
  EXPECT_FALSE(report.complete);
  EXPECT_NE(groupOf(report, IssueCode::kHdrVersionNewer), nullptr);
}

// Stands for any failure inside a rule.
class ThrowingFileSystem final : public FileSystem {
 public:
  Result<std::unique_ptr<ReadableFile>> open(const std::string&) const override { throw std::bad_alloc(); }
  Result<std::unique_ptr<WritableFile>> create(const std::string&) const override { throw std::bad_alloc(); }
  Result<PathType> typeOf(const std::string&) const override { throw std::bad_alloc(); }
  Result<std::vector<std::string>> list(const std::string&) const override { throw std::bad_alloc(); }
  Status makeDirectory(const std::string&) const override { throw std::bad_alloc(); }
  Status rename(const std::string&, const std::string&) const override { throw std::bad_alloc(); }
  Status renameNoReplace(const std::string&, const std::string&) const override { throw std::bad_alloc(); }
  Status removeFile(const std::string&) const override { throw std::bad_alloc(); }
  Status removeDirectory(const std::string&) const override { throw std::bad_alloc(); }
  Status syncFile(const std::string&) const override { throw std::bad_alloc(); }
  Status syncDirectory(const std::string&) const override { throw std::bad_alloc(); }
  Result<std::unique_ptr<FileLock>> lock(const std::string&) const override { throw std::bad_alloc(); }
};

TEST(CheckDatabase, failing_rule_is_an_internal_error_and_never_valid) {
  const Report report = check(ThrowingFileSystem());
  ASSERT_TRUE(report.fatal.has_value());
  EXPECT_EQ(report.fatal->kind, ErrorKind::kInternal);
  EXPECT_FALSE(report.complete);
}

// Replaces the database by another once its area.json has been read, when the first of its files is looked
// for.
class ReplacingFileSystem final : public FileSystem {
 public:
  explicit ReplacingFileSystem(const MemoryFileSystem& files) : files_(files) {}
  Result<PathType> typeOf(const std::string& path) const override {
    if (!replaced_ && path.ends_with("nodes-000001.dzn")) {
      replaced_ = true;
      SyntheticGridOptions other;
      other.seed = 2;
      BuildOptions options;
      options.overwrite = true;
      EXPECT_TRUE(buildTerrain(files_, syntheticGrid(other), kPath, options).ok());
    }
    return files_.typeOf(path);
  }
  Result<std::unique_ptr<ReadableFile>> open(const std::string& path) const override {
    return files_.open(path);
  }
  Result<std::unique_ptr<WritableFile>> create(const std::string& path) const override {
    return files_.create(path);
  }
  Result<std::vector<std::string>> list(const std::string& path) const override { return files_.list(path); }
  Status makeDirectory(const std::string& path) const override { return files_.makeDirectory(path); }
  Status rename(const std::string& from, const std::string& to) const override {
    return files_.rename(from, to);
  }
  Status renameNoReplace(const std::string& from, const std::string& to) const override {
    return files_.renameNoReplace(from, to);
  }
  Status removeFile(const std::string& path) const override { return files_.removeFile(path); }
  Status removeDirectory(const std::string& path) const override { return files_.removeDirectory(path); }
  Status syncFile(const std::string& path) const override { return files_.syncFile(path); }
  Status syncDirectory(const std::string& path) const override { return files_.syncDirectory(path); }
  Result<std::unique_ptr<FileLock>> lock(const std::string& path) const override { return files_.lock(path); }
  bool replaced() const { return replaced_; }

 private:
  const MemoryFileSystem& files_;
  mutable bool replaced_ = false;
};

TEST(CheckDatabase, a_database_replaced_under_the_check_is_checked_in_its_new_state) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  const ReplacingFileSystem replacing(files);
  const Report report = check(replacing);
  EXPECT_TRUE(replacing.replaced());
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.count(Severity::kError), 0u);
}

TEST(CheckDatabase, a_database_replaced_under_a_reader_opens_in_its_new_state) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  const ReplacingFileSystem replacing(files);
  const Result<Database> database = Database::open(replacing, kPath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  EXPECT_TRUE(replacing.replaced());
  EXPECT_EQ(database.value().area().generation, 2u);
}

}  // namespace
}  // namespace deltaz
