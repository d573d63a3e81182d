// The full-resolution posts of one grid, put together from its leaves: what the geometry rules measure
// against. Internal to libdb/check. Memory: five bytes a post.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "libdb/check/check_context.h"
#include "libdb/check/tile_loader.h"

namespace deltaz {

struct FullGrid {
  PostRange columns, rows;            // level-0 indices
  std::vector<std::int32_t> heights;  // row by row, quanta
  std::vector<std::uint8_t> valid;    // 1 or 0

  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - rows.begin) * columns.size() + (column - columns.begin));
  }
  bool isValid(std::int64_t column, std::int64_t row) const {
    return column >= columns.begin && column < columns.end && row >= rows.begin && row < rows.end &&
           valid[index(column, row)] != 0;
  }
  // Whether the triangle of the cell of `step` posts a side is drawn: (SW, SE, NE), or (SW, NE, NW) if `top`.
  bool isDrawn(std::int64_t column, std::int64_t row, bool top, std::int64_t step) const {
    return isValid(column, row) && isValid(column + step, row + step) &&
           (top ? isValid(column, row + step) : isValid(column + step, row));
  }
};

// Pre: the tree is sound and the terrain level found nothing wrong. Nothing if a leaf cannot be read.
std::optional<FullGrid> assembleGrid(CheckContext& context, TileLoader& loader, std::uint16_t grid);

// Level-0 posts of a node's extent, border included, as far as the area goes.
PostRange extentColumns(const GridGeometry& geometry, const NodeRecord& record);
PostRange extentRows(const GridGeometry& geometry, const NodeRecord& record);

}  // namespace deltaz
