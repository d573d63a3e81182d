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

// The part of a grid's plane for which a field is asked, level-0 posts: the grid and a margin, so that what
// lies at its edge is filtered whole.
struct ColorExtent {
  double west = 0, south = 0, east = 0, north = 0;
};
ColorExtent colorExtent(const GridHeader& grid);

// The first level, from below, whose nodes hold the grid two by two.
int colorRootLevel(const GridHeader& grid);

// The texels of a block whose centres lie inside; none: columns or rows are 0.
TexelBlock clippedBlock(const TexelBlock& block, int leaf_cells, const ColorExtent& extent);

// The texels of a node, of its own level or a finer one.
TexelBlock blockOf(const ColorPlace& place, int level);

// Children stand before their parents, and those of one parent next to each other but for what is below them.
// With `last_level` every node the field touches is there down to that level; else each has children where
// the field is finer than its texels.
std::vector<PlannedTile> planColorTiles(std::uint16_t number, const GridHeader& grid, const ColorField& field,
                                        std::optional<int> last_level);

}  // namespace deltaz
