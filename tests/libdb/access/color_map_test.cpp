#include "libdb/access/color_map.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "libdb/access/database.h"
#include "tests/support/asset_editor.h"
#include "tests/support/furnished_area.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

TEST(ColorNodes, lie_at_global_multiples_of_their_cells) {
  EXPECT_EQ(colorNodeCells(64, 0), 64);
  EXPECT_EQ(colorNodeCells(64, 3), 512);
  EXPECT_EQ(colorNodeCells(64, -8), 0.25);
  EXPECT_EQ(colorTexelCells(64, 1), 1);
  EXPECT_EQ(colorNodeAt(0, 64, 0), 0);
  EXPECT_EQ(colorNodeAt(63.999, 64, 0), 0);
  EXPECT_EQ(colorNodeAt(64, 64, 0), 1);
  EXPECT_EQ(colorNodeAt(-0.001, 64, 0), -1);
  EXPECT_EQ(colorNodeAt(-64, 64, 0), -1);
  EXPECT_EQ(colorNodeAt(100.3, 64, -6), 100);
}

// Half of a node's place is its child's place, also left of zero.
TEST(ColorNodes, stand_below_the_node_of_the_next_level) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1e6, 1e6);
  for (int k = 0; k < 10000; ++k) {
    const double posts = place(random);
    const int level = k % 20 - 10;
    EXPECT_EQ(colorNodeAt(posts, 8, level) >> 1, colorNodeAt(posts, 8, level + 1));
  }
}

TEST(ColorNodes, children_follow_each_other_in_the_order_of_their_numbers) {
  ColorNode node;
  node.first_child = 10;
  node.children = 0b1010;  // SE, NW
  EXPECT_EQ(childRecord(node, 1), 0u);
  EXPECT_EQ(childRecord(node, 2), 10u);
  EXPECT_EQ(childRecord(node, 3), 0u);
  EXPECT_EQ(childRecord(node, 4), 11u);
  node.children = 15;
  for (int child = 1; child <= 4; ++child)
    EXPECT_EQ(childRecord(node, child), 9u + static_cast<std::uint32_t>(child));
}

TEST(ColorMap, finds_the_texels_of_a_place) {
  const Database database = Database::open(furnishedArea(), kMemoryDatabasePath).value();
  ASSERT_EQ(database.findColorMap("summer"), 0u);
  EXPECT_FALSE(database.findColorMap("winter").has_value());
  const ColorMap& map = database.colorMaps().at(0);
  const GridHeader& grid = database.area().grids[0];
  const ColorFunction color = furnishedColors();
  ASSERT_NE(map.treeOf(0), nullptr);
  EXPECT_EQ(map.treeOf(1), nullptr);
  EXPECT_EQ(map.treeOf(0)->finest_level, kFurnishedColorLevel);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(0, 20), up(0, 18);
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    const double column = static_cast<double>(grid.x_axis.first) + along(random);
    const double row = static_cast<double>(grid.y_axis.first) + up(random);
    for (const int level : {-40, kFurnishedColorLevel, kFurnishedColorLevel + 3, 60}) {
      const auto node = map.nodeAt(0, column, row, level);
      ASSERT_TRUE(node.ok()) << node.error().message();
      if (!node.value()) continue;
      EXPECT_EQ(node.value()->level,
                std::clamp<int>(level, map.treeOf(0)->finest_level, map.treeOf(0)->coarsest_level));
      const double cells = colorNodeCells(grid.leaf_cells, node.value()->level);
      EXPECT_EQ(std::floor(column / cells), node.value()->x);
      EXPECT_EQ(std::floor(row / cells), node.value()->y);
      if (node.value()->level != kFurnishedColorLevel) continue;
      const double texel = colorTexelCells(grid.leaf_cells, kFurnishedColorLevel);
      const auto i = static_cast<std::size_t>((column - node.value()->x * cells) / texel);
      const auto j = static_cast<std::size_t>((row - node.value()->y * cells) / texel);
      const auto texels = map.tile(*node.value());
      ASSERT_TRUE(texels.ok()) << texels.error().message();
      const auto wanted = color(0, node.value()->x * cells + (static_cast<double>(i) + 0.5) * texel,
                                node.value()->y * cells + (static_cast<double>(j) + 0.5) * texel);
      const std::size_t at = 4 * ((j + 1) * kColorTileSide + i + 1);
      for (std::size_t value = 0; value < 4; ++value)
        ASSERT_EQ(texels.value()[at + value], wanted[value]) << column << ", " << row;
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
  // Far away there are none.
  EXPECT_FALSE(map.nodeAt(0, -1e9, 0, 4).value().has_value());
  EXPECT_FALSE(map.nodeAt(7, 0, 0, 4).value().has_value());
}

TEST(ColorMap, reads_pages_and_tiles_only_when_asked) {
  const Database database = Database::open(furnishedArea(), kMemoryDatabasePath).value();
  const ColorMap& map = database.colorMaps().at(0);
  const std::uint64_t after_open = map.file().bytesRead();
  const ColorNode root = map.record(1).value();
  const std::uint64_t after_record = map.file().bytesRead();
  EXPECT_GT(after_record, after_open);
  ASSERT_TRUE(map.record(map.directory().node_count).ok());
  EXPECT_EQ(map.file().bytesRead(), after_record) << "a page is read once";
  ASSERT_TRUE(map.tile(root).ok());
  EXPECT_GT(map.file().bytesRead(), after_record);
  EXPECT_EQ(map.record(0).error().code, IssueCode::kColorTree);
  EXPECT_EQ(map.record(map.directory().node_count + 1).error().code, IssueCode::kColorTree);
}

TEST(ColorMap, a_child_in_a_wrong_place_is_an_error_and_no_colour) {
  MemoryFileSystem files = furnishedArea();
  changeColors(files, [](ColorParts& parts) {
    for (ColorNode& node : parts.nodes) node.x += node.level == parts.directory.trees[0].finest_level ? 2 : 0;
  });
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  const GridHeader& grid = database.area().grids[0];
  const auto node = database.colorMaps().at(0).nodeAt(0, static_cast<double>(grid.x_axis.first + 5),
                                                      static_cast<double>(grid.y_axis.first + 5), 0);
  ASSERT_FALSE(node.ok());
  EXPECT_EQ(node.error().code, IssueCode::kColorTree);
}

}  // namespace
}  // namespace deltaz
