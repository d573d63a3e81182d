#include "libdb/build/color_pyramid.h"

#include <cmath>
#include <gtest/gtest.h>

#include "libdb/access/color.h"
#include "libdb/access/database.h"
#include "libdb/build/color_plan.h"
#include "tests/support/color_map_fixture.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

using Code = std::array<std::uint8_t, 4>;

Code checkers(std::uint16_t, double column, double row) {
  const auto band = [](double value) { return static_cast<std::uint8_t>(std::lround(value * 3) & 0xFF); };
  return {band(column), band(row), static_cast<std::uint8_t>(band(column + row) ^ 0x55), 255};
}

// A disc of colour; none around it.
Code disc(std::uint16_t, double column, double row) {
  const double x = column - 12060, y = row - 16020;
  if (x * x + y * y > 1600) return {};
  return {200, 100, 50, static_cast<std::uint8_t>(x > 0 ? 255 : 90)};
}

Database opened(const MemoryFileSystem& files) {
  auto database = Database::open(files, kMemoryDatabasePath);
  EXPECT_TRUE(database.ok()) << database.error().message();
  return std::move(database).value();
}

Code texelAt(const std::vector<std::uint8_t>& tile, int column, int row) {
  const auto k =
      4 * (static_cast<std::size_t>(row + 1) * kColorTileSide + static_cast<std::size_t>(column + 1));
  return {tile[k], tile[k + 1], tile[k + 2], tile[k + 3]};
}

std::vector<ColorNode> allNodes(const ColorMap& map) {
  std::vector<ColorNode> nodes;
  for (std::uint32_t number = 1; number <= map.directory().node_count; ++number)
    nodes.push_back(map.record(number).value());
  return nodes;
}

const ColorNode* nodeAt(const std::vector<ColorNode>& nodes, int level, std::int32_t x, std::int32_t y) {
  for (const ColorNode& node : nodes) {
    if (node.level == level && node.x == x && node.y == y) return &node;
  }
  return nullptr;
}

MemoryFileSystem areaOf(const ColorFunction& color, int finest_level) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  addColorMapOf(files, kMemoryDatabasePath, "summer", finest_level, color);
  return files;
}

TEST(ColorPyramid, finest_texels_are_the_field_at_their_centres) {
  const MemoryFileSystem files = areaOf(checkers, 0);
  const Database database = opened(files);
  const ColorMap& map = database.colorMaps().front();
  ASSERT_EQ(map.treeOf(0)->finest_level, 0);
  const GridAxis &x = database.area().grids[0].x_axis, &y = database.area().grids[0].y_axis;
  for (std::int64_t c = 0; c < x.count; c += 7) {
    for (std::int64_t r = 0; r < y.count; r += 7) {
      const double column = static_cast<double>(x.first + c) + 0.25,
                   row = static_cast<double>(y.first + r) + 0.25;
      const auto node = map.nodeAt(0, column, row, 0).value();
      if (c == x.count - 1 || r == y.count - 1) continue;  // the next node need not be there
      ASSERT_TRUE(node && node->level == 0);
      const auto tile = map.tile(*node).value();
      const int i = static_cast<int>(2 * (column - 64.0 * node->x)),
                j = static_cast<int>(2 * (row - 64.0 * node->y));
      EXPECT_EQ(texelAt(tile, i, j), checkers(0, column, row));
    }
  }
}

TEST(ColorPyramid, coarser_texels_are_means_of_the_stored_ones_below) {
  for (const ColorFunction& color : {ColorFunction(checkers), ColorFunction(disc)}) {
    const MemoryFileSystem files = areaOf(color, -1);
    const Database database = opened(files);
    const ColorMap& map = database.colorMaps().front();
    int compared = 0;
    for (const ColorNode& node : allNodes(map)) {
      const auto tile = map.tile(node).value();
      for (int number = 1; number <= 4; ++number) {
        if (childRecord(node, number) == 0) continue;
        const ColorNode child = map.record(childRecord(node, number)).value();
        const auto finer = map.tile(child).value();
        const int east = number == 2 || number == 3 ? 64 : 0, north = number >= 3 ? 64 : 0;
        for (int j = 0; j < 64; ++j) {
          for (int i = 0; i < 64; ++i) {
            unsigned cover = 0;
            std::array<double, 3> light{};
            for (const auto& [di, dj] :
                 {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
              const Code part = texelAt(finer, 2 * i + di, 2 * j + dj);
              cover += part[3];
              for (std::size_t band = 0; band < 3; ++band) light[band] += part[3] * decodeSrgb(part[band]);
            }
            Code expected{0, 0, 0, static_cast<std::uint8_t>((cover + 2) / 4)};
            for (std::size_t band = 0; band < 3 && expected[3] > 0; ++band)
              expected[band] = encodeSrgb(light[band] / cover);
            ASSERT_EQ(texelAt(tile, east + i, north + j), expected);
            ++compared;
          }
        }
      }
    }
    EXPECT_GT(compared, 10 * 4096);
  }
}

TEST(ColorPyramid, borders_are_the_texels_of_the_neighbours) {
  const MemoryFileSystem files = areaOf(checkers, -1);
  const Database database = opened(files);
  const ColorMap& map = database.colorMaps().front();
  const std::vector<ColorNode> nodes = allNodes(map);
  int compared = 0;
  for (const ColorNode& node : nodes) {
    const auto tile = map.tile(node).value();
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const ColorNode* other = nodeAt(nodes, node.level, node.x + dx, node.y + dy);
        if ((dx == 0 && dy == 0) || other == nullptr) continue;
        const auto theirs = map.tile(*other).value();
        for (int k = 0; k < (dx != 0 && dy != 0 ? 1 : 128); ++k) {
          const int i = dx == 0 ? k : dx < 0 ? -1 : 128, j = dy == 0 ? k : dy < 0 ? -1 : 128;
          ASSERT_EQ(texelAt(tile, i, j), texelAt(theirs, i - 128 * dx, j - 128 * dy));
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(ColorPyramid, the_area_is_about_one_texel_of_the_coarsest_nodes) {
  const MemoryFileSystem files = areaOf(checkers, 0);
  const Database database = opened(files);
  const ColorMap& map = database.colorMaps().front();
  const ColorTree& tree = *map.treeOf(0);
  EXPECT_EQ(tree.coarsest_level, colorRootLevel(database.area().grids[0]) + kColorFarLevels);
  const double texel = colorTexelCells(64, tree.coarsest_level);
  EXPECT_GE(2 * texel, 120);
}

// Colour on the grid, to its very edge, and nowhere else.
TEST(ColorPyramid, texels_around_every_place_of_the_grid_are_covered_at_every_level) {
  const GridHeader grid = syntheticGrid().header;
  const auto first_x = static_cast<double>(grid.x_axis.first),
             first_y = static_cast<double>(grid.y_axis.first);
  const double last_x = first_x + static_cast<double>(grid.x_axis.count - 1),
               last_y = first_y + static_cast<double>(grid.y_axis.count - 1);
  const Code red = {200, 30, 10, 255};
  const auto color = [&](std::uint16_t, double column, double row) {
    return column >= first_x && column <= last_x && row >= first_y && row <= last_y ? red : Code{};
  };
  for (const int finest : {-1, 1, 4, 7}) {
    const MemoryFileSystem files = areaOf(color, finest);
    const Database database = opened(files);
    const ColorMap& map = database.colorMaps().front();
    const ColorTree& tree = *map.treeOf(0);
    EXPECT_EQ(tree.finest_level, finest);
    for (int level = finest; level <= tree.coarsest_level; ++level) {
      const double texel = colorTexelCells(64, level);
      for (const double column : {first_x, first_x + 0.6 * (last_x - first_x), last_x - 0.01}) {
        for (const double row : {first_y, first_y + 0.3 * (last_y - first_y), last_y - 0.01}) {
          const auto node = map.nodeAt(0, column, row, level).value();
          ASSERT_TRUE(node && node->level == level) << level;
          const auto tile = map.tile(*node).value();
          const int i = static_cast<int>(std::floor(column / texel) - 128.0 * node->x),
                    j = static_cast<int>(std::floor(row / texel) - 128.0 * node->y);
          for (int dj = -1; dj <= 1; ++dj) {
            for (int di = -1; di <= 1; ++di)
              ASSERT_EQ(texelAt(tile, i + di, j + dj), red) << level << " " << column << " " << row;
          }
        }
      }
    }
  }
}

TEST(ColorPyramid, nodes_without_cover_are_not_there) {
  const MemoryFileSystem files = areaOf(disc, -2);
  const Database database = opened(files);
  const ColorMap& map = database.colorMaps().front();
  for (const ColorNode& node : allNodes(map)) {
    const auto tile = map.tile(node).value();
    bool covered = false;
    for (int j = 0; j < 128; ++j) {
      for (int i = 0; i < 128; ++i) covered = covered || texelAt(tile, i, j)[3] > 0;
    }
    EXPECT_TRUE(covered || node.children != 0) << int{node.level};
  }
  EXPECT_EQ(map.nodeAt(0, 12060 - 58, 16020 - 58, -2).value()->level > -2, true);
  EXPECT_EQ(map.nodeAt(0, 12060, 16020, -2).value()->level, -2);
}

TEST(ColorPyramid, adding_a_map_leaves_the_terrain_files_alone) {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  const MemoryFileSystem before = files;
  addColorMapOf(files, kMemoryDatabasePath, "summer", 1, checkers);
  for (const std::string& path : before.paths()) {
    if (path.ends_with("area.json") || path.ends_with("lock")) continue;
    EXPECT_EQ(before.bytes(path), files.bytes(path)) << path;
  }
}

}  // namespace
}  // namespace deltaz
