#include "libdb/build/pyramid.h"

namespace deltaz {

namespace {

// Child numbers 1 to 4 run counter-clockwise from the south-west (report Fig 47).
constexpr std::array<std::array<std::int32_t, 2>, 4> kChildSteps = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

bool contains(PostRange range, std::int64_t value) {
  return value >= range.begin && value < range.end;
}

}  // namespace

PyramidPlan planPyramid(const GridGeometry& geometry) {
  PyramidPlan plan;
  int top = 0;
  while (geometry.nodeColumnsAt(top).size() > 2 || geometry.nodeRowsAt(top).size() > 2) ++top;
  plan.level_count = top + 1;
  plan.level_begin.resize(static_cast<std::size_t>(plan.level_count));
  plan.level_end.resize(static_cast<std::size_t>(plan.level_count));

  const PostRange top_columns = geometry.nodeColumnsAt(top);
  const PostRange top_rows = geometry.nodeRowsAt(top);
  for (std::int64_t y = top_rows.begin; y < top_rows.end; ++y) {
    for (std::int64_t x = top_columns.begin; x < top_columns.end; ++x) {
      PlannedNode node;
      node.level = top;
      node.x = static_cast<std::int32_t>(x);
      node.y = static_cast<std::int32_t>(y);
      plan.nodes.push_back(node);
    }
  }
  plan.level_end[static_cast<std::size_t>(top)] = static_cast<std::uint32_t>(plan.nodes.size());

  for (int level = top - 1; level >= 0; --level) {
    const PostRange columns = geometry.nodeColumnsAt(level);
    const PostRange rows = geometry.nodeRowsAt(level);
    const std::uint32_t parents_begin = plan.level_begin[static_cast<std::size_t>(level + 1)];
    const std::uint32_t parents_end = plan.level_end[static_cast<std::size_t>(level + 1)];
    plan.level_begin[static_cast<std::size_t>(level)] = static_cast<std::uint32_t>(plan.nodes.size());
    for (std::uint32_t parent = parents_begin; parent < parents_end; ++parent) {
      for (std::size_t number = 0; number < kChildSteps.size(); ++number) {
        PlannedNode child;
        child.level = level;
        child.x = 2 * plan.nodes[parent].x + kChildSteps[number][0];
        child.y = 2 * plan.nodes[parent].y + kChildSteps[number][1];
        if (!contains(columns, child.x) || !contains(rows, child.y)) continue;
        child.child_number = static_cast<std::uint8_t>(number + 1);
        child.parent = parent;
        if (plan.nodes[parent].child_count++ == 0)
          plan.nodes[parent].first_child = static_cast<std::uint32_t>(plan.nodes.size());
        plan.nodes.push_back(child);
      }
    }
    plan.level_end[static_cast<std::size_t>(level)] = static_cast<std::uint32_t>(plan.nodes.size());
  }
  return plan;
}

TerrainTile cutTile(const RawGrid& grid, const GridGeometry& geometry, int level, std::int32_t x,
                    std::int32_t y) {
  const PostRange columns = geometry.nodePosts(geometry.columnsAt(level), x);
  const PostRange rows = geometry.nodePosts(geometry.rowsAt(level), y);
  TerrainTile tile;
  tile.level = level;
  tile.x = x;
  tile.y = y;
  tile.columns = static_cast<int>(columns.size());
  tile.rows = static_cast<int>(rows.size());
  const std::int64_t leaf = geometry.header().leaf_cells;
  // A node that holds no post of its level keeps its corner as the first.
  tile.first_column = tile.columns > 0 ? columns.begin : x * leaf;
  tile.first_row = tile.rows > 0 ? rows.begin : y * leaf;
  const std::size_t size =
      static_cast<std::size_t>(tile.columns + 2) * static_cast<std::size_t>(tile.rows + 2);
  tile.heights.assign(size, 0);
  tile.valid.assign(size, 0);
  if (!grid.void_kinds.empty()) tile.void_kinds.assign(size, 0);
  const std::int64_t step = std::int64_t{1} << level;
  const GridAxis& longitude = grid.header.x_axis;
  const GridAxis& latitude = grid.header.y_axis;
  for (int j = -1; j <= tile.rows; ++j) {
    const std::int64_t row = (tile.first_row + j) * step - latitude.first;
    if (row < 0 || row >= latitude.count) continue;
    for (int i = -1; i <= tile.columns; ++i) {
      const std::int64_t column = (tile.first_column + i) * step - longitude.first;
      if (column < 0 || column >= longitude.count) continue;
      if (!grid.isValid(column, row)) {
        if (!grid.void_kinds.empty())
          tile.void_kinds[tile.index(i, j)] =
              grid.void_kinds[static_cast<std::size_t>(row * longitude.count + column)];
        continue;
      }
      tile.heights[tile.index(i, j)] = grid.height(column, row);
      tile.valid[tile.index(i, j)] = 1;
    }
  }
  return tile;
}

}  // namespace deltaz
