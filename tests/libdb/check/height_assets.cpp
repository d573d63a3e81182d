// Terrain that contradicts itself, its neighbours or its grid.
#include <cmath>
#include <gtest/gtest.h>

#include "formats/patch_lattice.h"
#include "tests/libdb/check/code_assets.h"
#include "tests/support/block_changes.h"
#include "tests/support/projected_grid.h"

namespace deltaz {

namespace {

std::size_t postIndex(const TerrainBlock& block, int column, int row) {
  return static_cast<std::size_t>(row + 1) * (block.columns + 2u) + static_cast<std::size_t>(column + 1);
}

// Changes the height of one post by one quantum towards the middle of the node's range, so that the range
// stays.
void nudge(DatabaseEditor& editor, std::uint32_t number, int column, int row) {
  TerrainBlock block = editor.block(number);
  const NodeRecord& node = editor.record(number);
  std::int32_t& height = block.heights.at(postIndex(block, column, row));
  ASSERT_NE(height, node.minimum_height);
  ASSERT_NE(height, node.maximum_height);
  height += height * 2 < node.minimum_height + node.maximum_height ? 1 : -1;
  editor.setBlock(number, block);
}

using ChangeBlocks = std::function<void(std::vector<std::vector<std::byte>>&)>;

// A small projected database whose rows of control points are changed.
Recipe withControls(const ChangeBlocks& change, CheckLevel level) {
  return [change, level](const MemoryFileSystem&) {
    MemoryFileSystem files =
        buildInMemory(projectedGrid({.columns = 41, .rows = 37, .patch_cells = 16}), smallLeaves());
    changeBlocks(files, FileRole::kPatches, ContentKind::kPatches, BlockType::kPatchRow, change);
    return checkedAt(files, level);
  };
}

// Two grids, one lying in the other, whose seam is changed.
Recipe withSeam(const std::function<void(std::vector<std::byte>&)>& change) {
  return [change](const MemoryFileSystem&) {
    MemoryFileSystem files = areaWithInset();
    changeSeam(files, change);
    return checkedAt(files, CheckLevel::kGeometry);
  };
}

// Moves the third point of the third row: along the meridian, which is in the surface, or along the Earth's
// axis, which is not.
void moveControl(std::vector<std::vector<std::byte>>& rows, double metres, bool along_axis) {
  const auto points = static_cast<std::int64_t>(rows[2].size() / 24);
  std::vector<double> row = decodePatchRow(rows[2], points, "row").value();
  const double x = row[6], y = row[7], z = row[8], across = std::hypot(x, y), size = std::hypot(across, z);
  row[6] -= along_axis ? 0 : metres * z / size * x / across;
  row[7] -= along_axis ? 0 : metres * z / size * y / across;
  row[8] += along_axis ? metres : metres * across / size;
  rows[2] = encodePatchRow(row);
}

}  // namespace

std::vector<Asset> heightAssets() {
  return {
      {IssueCode::kHgtDecode, byEditing([](DatabaseEditor& editor) {
         // The count of ancestors no longer adds up with the block's length.
         editor.payloads.at(editor.record(innerLeaf(editor)).block).at(3) ^= std::byte{1};
       }),
       byEditing(changeAncestorErrors)},
      // An odd post in the middle of a coarse node: no coarser node has it, no neighbour sees it.
      {IssueCode::kHgtSubset,
       byEditing([](DatabaseEditor& editor) { nudge(editor, innerCoarseNode(editor), 3, 5); }), untouched()},
      // A ring post one step outside the western border.
      {IssueCode::kHgtRing,
       byEditing([](DatabaseEditor& editor) { nudge(editor, innerLeaf(editor), -1, 4); }),
       // What stands at a void post means nothing: here in a ring outside the area.
       byEditing([](DatabaseEditor& editor) {
         const std::uint32_t corner = editor.firstOf(0);
         TerrainBlock block = editor.block(corner);
         ASSERT_EQ(block.valid.at(postIndex(block, 0, -1)), 0);
         block.heights.at(postIndex(block, 0, -1)) += 5;
         editor.setBlock(corner, block);
       })},
      // A post with an odd row on the eastern border, away from the corners: no parent and no ring has it.
      {IssueCode::kHgtBorder,
       byEditing([](DatabaseEditor& editor) { nudge(editor, innerLeaf(editor), 8, 3); }), untouched()},
      // A row of control points short.
      {IssueCode::kHgtPatches, withControls([](auto& rows) { rows.pop_back(); }, CheckLevel::kDecode),
       withControls([](auto&) {}, CheckLevel::kGeometry)},
      // One removed cell too many in the header's count; a larger error, which says nothing wrong.
      {IssueCode::kHgtSeam, withSeam([](auto& seam) { seam.at(4) ^= std::byte{1}; }),
       withSeam([](auto& seam) { seam.at(24) ^= std::byte{1}; })},
  };
}

TEST(ControlPoints, one_beside_the_ellipsoid_or_out_of_line_is_found) {
  for (const bool along_axis : {false, true}) {
    const auto move = [&](auto& rows) { moveControl(rows, 0.002, along_axis); };
    const Report report = withControls(move, CheckLevel::kGeometry)({});
    ASSERT_EQ(report.groups.size(), 1u) << listing(report);
    EXPECT_EQ(report.groups[0].code, IssueCode::kHgtPatches) << listing(report);
    // The lower levels cannot see it.
    EXPECT_TRUE(withControls(move, CheckLevel::kDecode)({}).groups.empty());
  }
}

}  // namespace deltaz
