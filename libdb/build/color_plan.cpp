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

// Numbers of nodes, or texels, that meet the cells, first and last.
std::array<double, 2> nodesOver(const Cells& cells, double node) {
  return {std::floor(cells.begin / node), std::ceil(cells.end / node) - 1};
}

PlaneSpan spanOver(const GridHeader& grid, double side) {
  const auto columns = nodesOver(cellsOf(grid.x_axis), side), rows = nodesOver(cellsOf(grid.y_axis), side);
  return {static_cast<std::int64_t>(columns[0]), static_cast<std::int64_t>(columns[1]),
          static_cast<std::int64_t>(rows[0]), static_cast<std::int64_t>(rows[1])};
}

class Planner {
 public:
  Planner(std::uint16_t number, const GridHeader& grid, const ColorField& field,
          std::optional<int> last_level)
      : number_(number),
        grid_(grid),
        field_(field),
        last_level_(last_level),
        root_level_(colorRootLevel(grid)) {}

  std::vector<PlannedTile> run() {
    const int level = root_level_ + kColorFarLevels;
    const PlaneSpan span = nodesOverGrid(grid_, level);
    for (std::int64_t y = span.first_row; y <= span.last_row; ++y) {
      for (std::int64_t x = span.first_column; x <= span.last_column; ++x) {
        (void)plan({number_, static_cast<std::int8_t>(level), static_cast<std::int32_t>(x),
                    static_cast<std::int32_t>(y)});
      }
    }
    return std::move(tiles_);
  }

 private:
  bool meetsGrid(const ColorPlace& place) const {
    const PlaneSpan span = nodesOverGrid(grid_, place.level);
    return span.holdsColumn(place.x) && span.holdsRow(place.y);
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
    const TexelBlock block = clampedBlock(blockOf(place, level), texelsOverGrid(grid_, level));
    if (!field_.touches(block)) return kNoTile;
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
  std::vector<PlannedTile> tiles_;
};

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

PlaneSpan nodesOverGrid(const GridHeader& grid, int level) {
  return spanOver(grid, colorNodeCells(grid.leaf_cells, level));
}

PlaneSpan texelsOverGrid(const GridHeader& grid, int level) {
  return spanOver(grid, colorTexelCells(grid.leaf_cells, level));
}

std::optional<PlaneSpan> centresOverGrid(const GridHeader& grid, int level) {
  const double texel = colorTexelCells(grid.leaf_cells, level);
  const auto between = [&](const Cells& cells) {
    return std::array<std::int64_t, 2>{static_cast<std::int64_t>(std::ceil(cells.begin / texel - 0.5)),
                                       static_cast<std::int64_t>(std::floor(cells.end / texel - 0.5))};
  };
  const auto columns = between(cellsOf(grid.x_axis)), rows = between(cellsOf(grid.y_axis));
  if (columns[0] > columns[1] || rows[0] > rows[1]) return {};
  return PlaneSpan{columns[0], columns[1], rows[0], rows[1]};
}

TexelBlock clampedBlock(const TexelBlock& block, const PlaneSpan& span) {
  const auto column = [&](std::int64_t index) {
    return std::clamp(index, span.first_column, span.last_column);
  };
  const auto row = [&](std::int64_t index) { return std::clamp(index, span.first_row, span.last_row); };
  TexelBlock clamped = block;
  clamped.first_column = column(block.first_column);
  clamped.first_row = row(block.first_row);
  clamped.columns =
      static_cast<int>(column(block.first_column + block.columns - 1) - clamped.first_column) + 1;
  clamped.rows = static_cast<int>(row(block.first_row + block.rows - 1) - clamped.first_row) + 1;
  return clamped;
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
