#include "libdb/check/full_grid.h"

#include <algorithm>
#include <atomic>
#include <oneapi/tbb/parallel_for.h>

namespace deltaz {

std::optional<FullGrid> assembleGrid(CheckContext& context, TileLoader& loader, std::uint16_t grid) {
  const GridGeometry& geometry = context.grids[grid];
  FullGrid full;
  full.columns = geometry.columnsAt(0);
  full.rows = geometry.rowsAt(0);
  const auto posts = static_cast<std::size_t>(full.columns.size() * full.rows.size());
  full.heights.assign(posts, 0);
  full.valid.assign(posts, 0);
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t number = 1; number <= context.records.size(); ++number) {
    const NodeRecord& record = context.record(number);
    if (record.type == NodeType::kTerrain && record.grid == grid && record.level == 0)
      leaves.push_back(number);
  }
  const std::int64_t leaf = geometry.header().leaf_cells;
  const PostRange node_columns = geometry.nodeColumnsAt(0), node_rows = geometry.nodeRowsAt(0);
  std::atomic<bool> complete = true;
  oneapi::tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t item) {
    const TilePointer tile = loader.find(leaves[item]);
    if (!tile) {
      complete = false;
      return;
    }
    const NodeRecord& record = context.record(leaves[item]);
    // A shared post is written by one leaf only.
    for (std::int64_t row = tile->rows.begin; row < tile->rows.end; ++row) {
      if (ownerOf(row, leaf, node_rows) != record.y) continue;
      for (std::int64_t column = tile->columns.begin; column < tile->columns.end; ++column) {
        if (ownerOf(column, leaf, node_columns) != record.x || !tile->isValid(column, row)) continue;
        full.heights[full.index(column, row)] = tile->height(column, row);
        full.valid[full.index(column, row)] = 1;
      }
    }
  });
  if (!complete) return std::nullopt;
  return full;
}

namespace {

PostRange extent(PostRange all, std::int64_t leaf_cells, const NodeRecord& record, std::int32_t position) {
  const std::int64_t span = leaf_cells << record.level;
  return {std::max(all.begin, position * span), std::min(all.end, (position + 1) * span + 1)};
}

}  // namespace

PostRange extentColumns(const GridGeometry& geometry, const NodeRecord& record) {
  return extent(geometry.columnsAt(0), geometry.header().leaf_cells, record, record.x);
}
PostRange extentRows(const GridGeometry& geometry, const NodeRecord& record) {
  return extent(geometry.rowsAt(0), geometry.header().leaf_cells, record, record.y);
}

}  // namespace deltaz
