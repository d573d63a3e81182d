#include "libdb/build/color_filter.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "libdb/access/color_map.h"

namespace deltaz {

namespace {

constexpr int kChunk = 64;

// The colours of a block, each from the nearest texel of `part`.
void spread(const TexelBlock& part, std::span<const CoveredColor> of_part, const TexelBlock& block,
            std::span<CoveredColor> colors) {
  std::size_t k = 0;
  for (std::int64_t row = block.first_row; row < block.first_row + block.rows; ++row) {
    const std::int64_t from = std::clamp<std::int64_t>(row - part.first_row, 0, part.rows - 1) * part.columns;
    for (std::int64_t column = block.first_column; column < block.first_column + block.columns; ++column) {
      const std::int64_t nearest = std::clamp<std::int64_t>(column - part.first_column, 0, part.columns - 1);
      colors[k++] = of_part[static_cast<std::size_t>(from + nearest)];
    }
  }
}

}  // namespace

ColorFilter::ColorFilter(const ColorField& field, const GridHeader& grid)
    : field_(field), grid_(grid), root_level_(colorRootLevel(grid)) {}

Status ColorFilter::texels(const TexelBlock& block, std::span<CoveredColor> colors) const {
  const TexelBlock over = clampedBlock(block, texelsOverGrid(grid_, block.level));
  std::vector<CoveredColor> of_grid(static_cast<std::size_t>(over.columns) *
                                    static_cast<std::size_t>(over.rows));
  std::vector<CoveredColor> part;
  for (int row = 0; row < over.rows; row += kChunk) {
    for (int column = 0; column < over.columns; column += kChunk) {
      const TexelBlock piece{over.grid,
                             over.level,
                             over.first_column + column,
                             over.first_row + row,
                             std::min(kChunk, over.columns - column),
                             std::min(kChunk, over.rows - row)};
      part.assign(static_cast<std::size_t>(piece.columns) * static_cast<std::size_t>(piece.rows), {});
      DELTAZ_TRY(chunk(piece, part));
      for (int j = 0; j < piece.rows; ++j) {
        std::copy_n(part.begin() + std::ptrdiff_t{j} * piece.columns, piece.columns,
                    of_grid.begin() + std::ptrdiff_t{row + j} * over.columns + column);
      }
    }
  }
  spread(over, of_grid, block, colors);
  return Success{};
}

// All of the block's texels hold a part of the grid; `colors` has no cover yet.
Status ColorFilter::chunk(const TexelBlock& block, std::span<CoveredColor> colors) const {
  if (block.level <= root_level_ && !field_.touches(block)) return Success{};
  const std::optional<PlaneSpan> centres = centresOverGrid(grid_, block.level);
  // Texels coarser than the root level's hold much of the grid each, or all of it, wherever their centres
  // are.
  if (block.level > root_level_ || !centres ||
      (block.level > kLowestColorLevel && field_.isFiner(block, block.level))) {
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
  const TexelBlock inside = clampedBlock(block, *centres);
  std::vector<CoveredColor> samples(static_cast<std::size_t>(inside.columns) *
                                    static_cast<std::size_t>(inside.rows));
  DELTAZ_TRY(field_.sample(inside, samples));
  spread(inside, samples, block, colors);
  return Success{};
}

}  // namespace deltaz
