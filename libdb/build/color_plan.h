// Which nodes a colour map has over a grid, before any texel is known: from nodes so coarse that the grid is
// about a texel of them down to where the field shows no more than texels hold.
//
// Cost: one question to the field a node. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/area.h"
#include "libdb/build/color_field.h"
#include "libdb/build/color_map_writer.h"

namespace deltaz {

// Levels above the first whose nodes, two by two, hold the grid: 128 texels shrink to one.
inline constexpr int kColorFarLevels = 7;

inline constexpr std::int32_t kNoTile = -1;

struct PlannedTile {
  ColorPlace place;
  std::int32_t parent = kNoTile;                                                // index into the plan
  std::array<std::int32_t, 4> children = {kNoTile, kNoTile, kNoTile, kNoTile};  // 1 SW, 2 SE, 3 NE, 4 NW
};

// Whole numbers of nodes or texels along both axes, first and last.
struct PlaneSpan {
  std::int64_t first_column = 0, last_column = -1, first_row = 0, last_row = -1;
  bool holdsColumn(std::int64_t column) const { return column >= first_column && column <= last_column; }
  bool holdsRow(std::int64_t row) const { return row >= first_row && row <= last_row; }
};
// Those of a level that hold a part of the grid.
PlaneSpan nodesOverGrid(const GridHeader& grid, int level);
PlaneSpan texelsOverGrid(const GridHeader& grid, int level);
// The texels whose centres lie in the grid; nothing if it is thinner than a texel and falls between them.
std::optional<PlaneSpan> centresOverGrid(const GridHeader& grid, int level);

// The first level, from below, whose nodes hold the grid two by two.
int colorRootLevel(const GridHeader& grid);

// The texels of the span nearest to those of a block: at least one.
TexelBlock clampedBlock(const TexelBlock& block, const PlaneSpan& span);

// The texels of a node, of its own level or a finer one.
TexelBlock blockOf(const ColorPlace& place, int level);

// Children stand before their parents, and those of one parent next to each other but for what is below them.
// With `last_level` every node the field touches is there down to that level; else each has children where
// the field is finer than its texels.
std::vector<PlannedTile> planColorTiles(std::uint16_t number, const GridHeader& grid, const ColorField& field,
                                        std::optional<int> last_level);

}  // namespace deltaz
