#include "libdb/build/color_filter.h"

#include <algorithm>
#include <vector>

#include "libdb/access/color_map.h"

namespace deltaz {

namespace {

constexpr int kChunk = 64;

}  // namespace

ColorFilter::ColorFilter(const ColorField& field, const GridHeader& grid)
    : field_(field),
      leaf_cells_(grid.leaf_cells),
      root_level_(colorRootLevel(grid)),
      extent_(colorExtent(grid)) {}

bool ColorFilter::meetsExtent(const TexelBlock& block) const {
  const double texel = colorTexelCells(leaf_cells_, block.level);
  const auto at = [&](std::int64_t index) { return static_cast<double>(index) * texel; };
  return at(block.first_column) < extent_.east && at(block.first_column + block.columns) > extent_.west &&
         at(block.first_row) < extent_.north && at(block.first_row + block.rows) > extent_.south;
}

Status ColorFilter::texels(const TexelBlock& block, std::span<CoveredColor> colors) const {
  std::vector<CoveredColor> part;
  for (int row = 0; row < block.rows; row += kChunk) {
    for (int column = 0; column < block.columns; column += kChunk) {
      const TexelBlock piece{block.grid,
                             block.level,
                             block.first_column + column,
                             block.first_row + row,
                             std::min(kChunk, block.columns - column),
                             std::min(kChunk, block.rows - row)};
      part.assign(static_cast<std::size_t>(piece.columns) * static_cast<std::size_t>(piece.rows), {});
      DELTAZ_TRY(chunk(piece, part));
      for (int j = 0; j < piece.rows; ++j) {
        std::copy_n(part.begin() + std::ptrdiff_t{j} * piece.columns, piece.columns,
                    colors.begin() + std::ptrdiff_t{row + j} * block.columns + column);
      }
    }
  }
  return Success{};
}

// `colors` has no cover yet.
Status ColorFilter::chunk(const TexelBlock& block, std::span<CoveredColor> colors) const {
  if (!meetsExtent(block)) return Success{};
  const TexelBlock inside = clippedBlock(block, leaf_cells_, extent_);
  const bool any = inside.columns > 0 && inside.rows > 0;
  if (block.level <= root_level_) {
    if (!any || !field_.touches(inside)) return Success{};
  }
  // Texels coarser than that hold much of the grid each, or all of it, wherever their centres are.
  if (block.level > root_level_ || (block.level > kLowestColorLevel && field_.isFiner(inside, block.level))) {
    const TexelBlock below{block.grid,          block.level - 1,   2 * block.first_column,
                           2 * block.first_row, 2 * block.columns, 2 * block.rows};
    const auto columns = static_cast<std::size_t>(below.columns);
    std::vector<CoveredColor> finer(columns * static_cast<std::size_t>(below.rows));
    DELTAZ_TRY(texels(below, finer));
    std::size_t k = 0;
    for (std::size_t row = 0; row < static_cast<std::size_t>(below.rows); row += 2) {
      for (std::size_t column = 0; column < columns; column += 2) {
        CoveredColor& color = colors[k++];
        const CoveredColor* const south = &finer[row * columns + column];
        for (const CoveredColor* part : {south, south + 1, south + columns, south + columns + 1}) {
          color.red += 0.25 * part->red;
          color.green += 0.25 * part->green;
          color.blue += 0.25 * part->blue;
          color.cover += 0.25 * part->cover;
        }
      }
    }
    return Success{};
  }
  std::vector<CoveredColor> samples(static_cast<std::size_t>(inside.columns) *
                                    static_cast<std::size_t>(inside.rows));
  DELTAZ_TRY(field_.sample(inside, samples));
  for (int row = 0; row < inside.rows; ++row) {
    std::copy_n(samples.begin() + std::ptrdiff_t{row} * inside.columns, inside.columns,
                colors.begin() + std::ptrdiff_t{inside.first_row - block.first_row + row} * block.columns +
                    (inside.first_column - block.first_column));
  }
  return Success{};
}

}  // namespace deltaz
