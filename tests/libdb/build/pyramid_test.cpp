#include "libdb/build/pyramid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <set>
#include <tuple>

#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

GridHeader headerOf(std::int64_t first_column, std::int64_t columns, std::int64_t first_row,
                    std::int64_t rows) {
  GridHeader header = syntheticGrid().header;
  header.leaf_cells = 8;
  header.x_axis.first = first_column;
  header.x_axis.count = columns;
  header.y_axis.first = first_row;
  header.y_axis.count = rows;
  return header;
}

RC_GTEST_PROP(Pyramid, every_node_stands_once_behind_its_parent_and_between_its_level, ()) {
  const GridGeometry geometry(
      headerOf(*rc::gen::inRange<std::int64_t>(-200, 200), *rc::gen::inRange<std::int64_t>(2, 200),
               *rc::gen::inRange<std::int64_t>(-200, 200), *rc::gen::inRange<std::int64_t>(2, 200)));
  const PyramidPlan plan = planPyramid(geometry);
  std::set<std::tuple<int, int, int>> places;
  for (std::uint32_t index = 0; index < plan.nodes.size(); ++index) {
    const PlannedNode& node = plan.nodes[index];
    RC_ASSERT(places.emplace(node.level, node.x, node.y).second);
    if (index > 0) RC_ASSERT(node.level <= plan.nodes[index - 1].level);
    if (node.parent == kNoNode) {
      RC_ASSERT(node.level == plan.level_count - 1);
      continue;
    }
    const PlannedNode& parent = plan.nodes[node.parent];
    RC_ASSERT(node.parent < index);
    RC_ASSERT(parent.x == floorDivide(node.x, 2) && parent.y == floorDivide(node.y, 2) &&
              parent.level == node.level + 1);
    RC_ASSERT(index >= parent.first_child && index < parent.first_child + parent.child_count);
  }
  for (int level = 0; level < plan.level_count; ++level) {
    const auto count = geometry.nodeColumnsAt(level).size() * geometry.nodeRowsAt(level).size();
    RC_ASSERT(static_cast<std::int64_t>(plan.level_end[static_cast<std::size_t>(level)] -
                                        plan.level_begin[static_cast<std::size_t>(level)]) == count);
  }
  const std::size_t top = plan.level_end[static_cast<std::size_t>(plan.level_count - 1)];
  RC_ASSERT(top <= 4);
}

TEST(Pyramid, the_ring_holds_the_neighbours_and_nothing_beyond_the_area) {
  const RawGrid grid = syntheticGrid();
  const GridGeometry geometry(grid.header);
  const PyramidPlan plan = planPyramid(geometry);
  for (const PlannedNode& node : plan.nodes) {
    const TerrainTile tile = cutTile(grid, geometry, node.level, node.x, node.y);
    const std::int64_t step = std::int64_t{1} << node.level;
    for (int i = -1; i <= tile.columns; ++i) {
      const std::int64_t column = (tile.first_column + i) * step - grid.header.x_axis.first;
      const std::int64_t row = (tile.first_row - 1) * step - grid.header.y_axis.first;
      const bool inside = column >= 0 && column < grid.header.x_axis.count && row >= 0;
      ASSERT_EQ(tile.isValid(i, -1), inside);
      if (inside) {
        ASSERT_EQ(tile.height(i, -1), grid.height(column, row));
      }
    }
  }
}

}  // namespace
}  // namespace deltaz
