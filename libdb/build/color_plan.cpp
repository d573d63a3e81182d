#include "libdb/build/color_plan.h"

#include <algorithm>
#include <cmath>

#include "libdb/access/color_map.h"

namespace deltaz {

namespace {

// A grid's cells along one axis, half open.
struct Cells {
  double begin = 0, end = 0;
};

Cells cellsOf(const GridAxis& axis) {
  const auto first = static_cast<double>(axis.first);
  return {first, first + static_cast<double>(axis.count - 1)};
}

// Node numbers that meet the cells, first and last.
std::array<double, 2> nodesOver(const Cells& cells, double node) {
  return {std::floor(cells.begin / node), std::ceil(cells.end / node) - 1};
}

class Planner {
 public:
  Planner(std::uint16_t number, const GridHeader& grid, const ColorField& field,
          std::optional<int> last_level)
      : number_(number),
        grid_(grid),
        field_(field),
        last_level_(last_level),
        root_level_(colorRootLevel(grid)),
        extent_(colorExtent(grid)) {}

  std::vector<PlannedTile> run() {
    const int level = root_level_ + kColorFarLevels;
    const double node = colorNodeCells(grid_.leaf_cells, level);
    const auto columns = nodesOver(cellsOf(grid_.x_axis), node),
               rows = nodesOver(cellsOf(grid_.y_axis), node);
    for (double y = rows[0]; y <= rows[1]; ++y) {
      for (double x = columns[0]; x <= columns[1]; ++x) {
        (void)plan({number_, static_cast<std::int8_t>(level), static_cast<std::int32_t>(x),
                    static_cast<std::int32_t>(y)});
      }
    }
    return std::move(tiles_);
  }

 private:
  bool meetsGrid(const ColorPlace& place) const {
    const double node = colorNodeCells(grid_.leaf_cells, place.level);
    const auto columns = nodesOver(cellsOf(grid_.x_axis), node),
               rows = nodesOver(cellsOf(grid_.y_axis), node);
    return place.x >= columns[0] && place.x <= columns[1] && place.y >= rows[0] && place.y <= rows[1];
  }

  // A child's number must have room in 32 bits.
  static bool hasRoomBelow(const ColorPlace& place) {
    constexpr std::int32_t kMost = 1 << 30;
    return place.level > kLowestColorLevel && place.x >= -kMost && place.x < kMost && place.y >= -kMost &&
           place.y < kMost;
  }

  // The index of the node at `place`; kNoTile if there is none.
  std::int32_t plan(const ColorPlace& place) {
    if (!meetsGrid(place)) return kNoTile;
    // Coarser texels may have no centre in the grid at all.
    const int level = std::min<int>(place.level, root_level_);
    const TexelBlock block = clippedBlock(blockOf(place, level), grid_.leaf_cells, extent_);
    if (block.columns == 0 || block.rows == 0 || !field_.touches(block)) return kNoTile;
    PlannedTile tile;
    tile.place = place;
    const bool finer = last_level_ ? place.level > *last_level_ : field_.isFiner(block, place.level);
    if (finer && hasRoomBelow(place)) {
      for (int number = 1; number <= 4; ++number)
        tile.children[static_cast<std::size_t>(number - 1)] = plan(childPlace(place, number));
    }
    const auto index = static_cast<std::int32_t>(tiles_.size());
    for (const std::int32_t child : tile.children) {
      if (child != kNoTile) tiles_[static_cast<std::size_t>(child)].parent = index;
    }
    tiles_.push_back(tile);
    return index;
  }

  std::uint16_t number_;
  const GridHeader& grid_;
  const ColorField& field_;
  std::optional<int> last_level_;
  int root_level_;
  ColorExtent extent_;
  std::vector<PlannedTile> tiles_;
};

// The first and last of `count` texels from `first` on whose centres lie between; nothing left: first > last.
std::array<std::int64_t, 2> centresBetween(std::int64_t first, int count, double texel, double low,
                                           double high) {
  const double from = std::max(std::ceil(low / texel - 0.5), static_cast<double>(first));
  const double to = std::min(std::floor(high / texel - 0.5), static_cast<double>(first + count - 1));
  if (!(from <= to)) return {0, -1};
  return {static_cast<std::int64_t>(from), static_cast<std::int64_t>(to)};
}

}  // namespace

int colorRootLevel(const GridHeader& grid) {
  const auto fits = [&](int level) {
    const double node = colorNodeCells(grid.leaf_cells, level);
    for (const GridAxis* axis : {&grid.x_axis, &grid.y_axis}) {
      const auto nodes = nodesOver(cellsOf(*axis), node);
      if (nodes[1] - nodes[0] > 1) return false;
    }
    return true;
  };
  int level = kHighestColorLevel - kColorFarLevels;
  while (level > kLowestColorLevel && fits(level - 1)) --level;
  return level;
}

ColorExtent colorExtent(const GridHeader& grid) {
  const double margin = colorTexelCells(grid.leaf_cells, colorRootLevel(grid));
  const Cells x = cellsOf(grid.x_axis), y = cellsOf(grid.y_axis);
  return {x.begin - margin, y.begin - margin, x.end + margin, y.end + margin};
}

TexelBlock clippedBlock(const TexelBlock& block, int leaf_cells, const ColorExtent& extent) {
  const double texel = colorTexelCells(leaf_cells, block.level);
  const auto columns = centresBetween(block.first_column, block.columns, texel, extent.west, extent.east);
  const auto rows = centresBetween(block.first_row, block.rows, texel, extent.south, extent.north);
  TexelBlock clipped = block;
  clipped.first_column = columns[0];
  clipped.first_row = rows[0];
  clipped.columns = static_cast<int>(columns[1] - columns[0] + 1);
  clipped.rows = static_cast<int>(rows[1] - rows[0] + 1);
  return clipped;
}

TexelBlock blockOf(const ColorPlace& place, int level) {
  const int texels = kColorTileTexels << (place.level - level);
  return {place.grid, level, std::int64_t{place.x} * texels, std::int64_t{place.y} * texels, texels, texels};
}

std::vector<PlannedTile> planColorTiles(std::uint16_t number, const GridHeader& grid, const ColorField& field,
                                        std::optional<int> last_level) {
  return Planner(number, grid, field, last_level).run();
}

}  // namespace deltaz
