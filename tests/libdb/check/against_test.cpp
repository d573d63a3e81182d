// Databases of several sources against all of them, some of them, and others.
#include <gtest/gtest.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/hash.h"
#include "libdb/check/check.h"
#include "libdb/source/grid_cutting.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// A window of `whole` as if it had been read from a file of its own.
RawGrid piece(const RawGrid& whole, const PostWindow& window, const std::string& name) {
  RawGrid grid = whole;
  cutTo(grid, window);
  SourceDescription& source = grid.header.sources.front();
  source.name = name;
  source.content = hash128(std::as_bytes(std::span(name)));
  source.columns = window.columns;
  source.rows = window.rows;
  const double dx = whole.header.x_axis.spacing, dy = whole.header.y_axis.spacing;
  const SourceDescription& of_whole = whole.header.sources.front();
  const std::int64_t above = whole.header.y_axis.count - window.first_row - window.rows;
  source.geotransform[0] = of_whole.geotransform[0] + dx * static_cast<double>(window.first_column);
  source.geotransform[3] = of_whole.geotransform[3] - dy * static_cast<double>(above);
  return grid;
}

void raise(RawGrid& grid, std::int32_t by) {
  for (std::int32_t& height : grid.heights) height += by;
}

MemoryFileSystem built(std::span<const RawGrid> grids,
                       std::vector<std::pair<std::string, std::string>> provenance = {}) {
  MemoryFileSystem files;
  EXPECT_TRUE(files.makeDirectory("/folder").ok());
  BuildOptions options;
  options.leaf_cells = 16;
  options.provenance = std::move(provenance);
  const auto done = buildTerrain(files, grids, kMemoryDatabasePath, options);
  EXPECT_TRUE(done.ok()) << done.error().message();
  return files;
}

Report against(const MemoryFileSystem& files, const std::vector<RawGrid>& sources) {
  CheckOptions options;
  options.against = sources.data();
  options.against_count = sources.size();
  options.against_name = "sources";
  return checkDatabase(files, kMemoryDatabasePath, options);
}

std::uint64_t countOf(const Report& report, IssueCode code) {
  for (const IssueGroup& group : report.groups) {
    if (group.code == code) return group.count;
  }
  return 0;
}

void expectValid(const Report& report, std::uint64_t posts) {
  EXPECT_TRUE(report.groups.empty()) << report.groups.front().first.front().message;
  EXPECT_TRUE(report.complete) << report.skipped.front();
  EXPECT_EQ(report.posts_compared, posts);
}

// West and east halves with 21 columns in common, of other heights there; the west is named first.
struct Halves {
  RawGrid west, east, joined;
};
Halves halves() {
  const RawGrid whole = syntheticGrid();
  Halves made{piece(whole, {0, 71, 0, 121}, "west.tif"), piece(whole, {50, 71, 0, 121}, "east.tif"), whole};
  raise(made.east, 3);
  made.joined.header.sources = {made.west.header.sources.front(), made.east.header.sources.front()};
  for (std::int64_t row = 0; row < 121; ++row) {
    for (std::int64_t column = 71; column < 121; ++column)
      made.joined.heights[static_cast<std::size_t>(row * 121 + column)] += 3;
  }
  return made;
}

TEST(CheckAgainst, two_grids_of_one_lattice_go_to_their_own_sources_in_any_order) {
  const RawGrid whole = syntheticGrid();
  const RawGrid upper = piece(whole, {0, 121, 0, 121}, "upper.tif");
  RawGrid lower = piece(whole, {0, 121, 0, 121}, "lower.tif");
  raise(lower, 7);
  const MemoryFileSystem files = built(std::vector{upper, lower});
  expectValid(against(files, {upper, lower}), 2 * 121 * 121);
  expectValid(against(files, {lower, upper}), 2 * 121 * 121);
  // The same file twice is no more than once.
  expectValid(against(files, {lower, upper, lower}), 2 * 121 * 121);
  lower.heights.at(77) += 1;
  EXPECT_EQ(countOf(against(files, {lower, upper}), IssueCode::kSrcHeight), 1u);
}

TEST(CheckAgainst, of_sources_joined_into_a_grid_the_earlier_wins_whatever_the_order_given) {
  const Halves made = halves();
  const MemoryFileSystem files = built(std::span(&made.joined, 1));
  expectValid(against(files, {made.west, made.east}), 121 * 121);
  expectValid(against(files, {made.east, made.west}), 121 * 121);
  // One file that holds what both say stands for both.
  RawGrid copy = made.joined;
  copy.header.sources = {piece(syntheticGrid(), {0, 121, 0, 121}, "copy.tif").header.sources.front()};
  expectValid(against(files, {copy}), 121 * 121);
}

TEST(CheckAgainst, a_grid_none_of_whose_sources_is_given_leaves_the_report_incomplete) {
  const RawGrid whole = syntheticGrid();
  const RawGrid first = piece(whole, {0, 121, 0, 121}, "first.tif");
  const RawGrid second = piece(whole, {0, 60, 0, 50}, "second.tif");
  const Report report = against(built(std::vector{first, second}), {first});
  EXPECT_TRUE(report.groups.empty());
  EXPECT_FALSE(report.complete);
  ASSERT_EQ(report.skipped.size(), 1u);
  EXPECT_NE(report.skipped[0].find("3000 posts of grid 1"), std::string::npos) << report.skipped[0];
  EXPECT_NE(report.skipped[0].find("second.tif"), std::string::npos) << report.skipped[0];
  EXPECT_EQ(report.posts_compared, 121u * 121u);
}

TEST(CheckAgainst, what_a_source_covers_that_is_not_given_is_not_compared_and_the_rest_is) {
  Halves made = halves();
  const MemoryFileSystem files = built(std::span(&made.joined, 1));
  Report report = against(files, {made.east});
  EXPECT_TRUE(report.groups.empty());
  ASSERT_EQ(report.skipped.size(), 1u);
  EXPECT_NE(report.skipped[0].find(std::to_string(71 * 121) + " posts"), std::string::npos)
      << report.skipped[0];
  EXPECT_EQ(report.posts_compared, 50u * 121u);
  made.east.heights.at(20) += 1;  // under the west, where anything may be
  made.east.heights.at(40) += 1;
  report = against(files, {made.east});
  EXPECT_EQ(countOf(report, IssueCode::kSrcHeight), 1u);
  EXPECT_FALSE(report.complete);
}

TEST(CheckAgainst, a_source_outside_the_bounds_is_a_note_and_elsewhere_an_error) {
  SyntheticGridOptions apart;
  apart.west = -60.1;
  const RawGrid inside = syntheticGrid();
  const RawGrid outside = piece(syntheticGrid(apart), {0, 121, 0, 121}, "outside.tif");
  const Report noted =
      against(built(std::span(&inside, 1), {{"bounds", "-80,43,-79,44"}}), {inside, outside});
  expectValid(noted, 121 * 121);
  ASSERT_EQ(noted.notes.size(), 1u);
  EXPECT_NE(noted.notes[0].find("outside.tif"), std::string::npos) << noted.notes[0];
  const Report wrong = against(built(std::span(&inside, 1)), {inside, outside});
  EXPECT_GT(wrong.count(Severity::kError), 0u);
  EXPECT_TRUE(wrong.notes.empty());
}

}  // namespace
}  // namespace deltaz
