#include "libdb/source/void_filling.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace deltaz {

namespace {

// Rounds of relaxation on every level. The coarser levels have done most of the work, so a few even out what
// interpolation leaves.
constexpr int kRelaxations = 12;

struct Level {
  std::int64_t columns = 0, rows = 0;
  std::vector<double> heights;        // quanta
  std::vector<std::uint8_t> is_void;  // 1 where the height is ours to choose

  std::size_t at(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * columns + column);
  }
};

// Every height of the coarser level is the average of those below that are not void.
Level averaged(const Level& fine) {
  Level coarse;
  coarse.columns = (fine.columns + 1) / 2;
  coarse.rows = (fine.rows + 1) / 2;
  const auto size = static_cast<std::size_t>(coarse.columns * coarse.rows);
  coarse.heights.assign(size, 0);
  coarse.is_void.assign(size, 1);
  for (std::int64_t row = 0; row < coarse.rows; ++row) {
    for (std::int64_t column = 0; column < coarse.columns; ++column) {
      double sum = 0;
      int count = 0;
      for (std::int64_t j = 2 * row; j < std::min(2 * row + 2, fine.rows); ++j) {
        for (std::int64_t i = 2 * column; i < std::min(2 * column + 2, fine.columns); ++i) {
          if (fine.is_void[fine.at(i, j)] != 0) continue;
          sum += fine.heights[fine.at(i, j)];
          ++count;
        }
      }
      if (count == 0) continue;
      coarse.heights[coarse.at(column, row)] = sum / count;
      coarse.is_void[coarse.at(column, row)] = 0;
    }
  }
  return coarse;
}

// Where a finer index lies between two coarser ones: the lower of them, and the share of the upper.
struct Between {
  std::int64_t low = 0, high = 0;
  double share = 0;
};
Between between(std::int64_t fine, std::int64_t coarse_count) {
  const double position = std::max(0.0, 0.5 * static_cast<double>(fine) - 0.25);
  const auto low = std::min(static_cast<std::int64_t>(position), coarse_count - 1);
  return {low, std::min(low + 1, coarse_count - 1), position - static_cast<double>(low)};
}

void interpolateVoids(Level& fine, const Level& coarse) {
  for (std::int64_t row = 0; row < fine.rows; ++row) {
    const Between y = between(row, coarse.rows);
    for (std::int64_t column = 0; column < fine.columns; ++column) {
      if (fine.is_void[fine.at(column, row)] == 0) continue;
      const Between x = between(column, coarse.columns);
      const double south = coarse.heights[coarse.at(x.low, y.low)] * (1 - x.share) +
                           coarse.heights[coarse.at(x.high, y.low)] * x.share;
      const double north = coarse.heights[coarse.at(x.low, y.high)] * (1 - x.share) +
                           coarse.heights[coarse.at(x.high, y.high)] * x.share;
      fine.heights[fine.at(column, row)] = south * (1 - y.share) + north * y.share;
    }
  }
}

// Each void height becomes the average of its neighbours', in a fixed order.
void relax(Level& level) {
  for (int round = 0; round < kRelaxations; ++round) {
    for (std::int64_t row = 0; row < level.rows; ++row) {
      for (std::int64_t column = 0; column < level.columns; ++column) {
        if (level.is_void[level.at(column, row)] == 0) continue;
        double sum = 0;
        int count = 0;
        const auto add = [&](std::int64_t i, std::int64_t j) {
          if (i < 0 || j < 0 || i >= level.columns || j >= level.rows) return;
          sum += level.heights[level.at(i, j)];
          ++count;
        };
        add(column - 1, row);
        add(column + 1, row);
        add(column, row - 1);
        add(column, row + 1);
        if (count > 0) level.heights[level.at(column, row)] = sum / count;
      }
    }
  }
}

// Whether a post and all its neighbours are covered: then every facet at it is, but for folds of the others'.
bool isCoveredAround(const RawGrid& grid, std::span<const std::uint8_t> covered, std::int64_t column,
                     std::int64_t row) {
  const auto columns = grid.header.x_axis.count, rows = grid.header.y_axis.count;
  for (std::int64_t j = std::max<std::int64_t>(row - 1, 0); j <= std::min(row + 1, rows - 1); ++j) {
    for (std::int64_t i = std::max<std::int64_t>(column - 1, 0); i <= std::min(column + 1, columns - 1);
         ++i) {
      if (covered[static_cast<std::size_t>(j * columns + i)] == 0) return false;
    }
  }
  return true;
}

// Stretches the membrane: heights of all voids that are not covered.
void stretch(RawGrid& grid, std::span<const std::uint8_t> covered) {
  std::vector<Level> levels(1);
  levels[0].columns = grid.header.x_axis.count;
  levels[0].rows = grid.header.y_axis.count;
  levels[0].heights.assign(grid.heights.begin(), grid.heights.end());
  levels[0].is_void.resize(grid.valid.size());
  for (std::size_t k = 0; k < grid.valid.size(); ++k)
    levels[0].is_void[k] = grid.valid[k] == 0 && (covered.empty() || covered[k] == 0) ? 1 : 0;
  // Up to the first level without voids: the last one, of a single post, has none.
  while (std::find(levels.back().is_void.begin(), levels.back().is_void.end(), std::uint8_t{1}) !=
         levels.back().is_void.end())
    levels.push_back(averaged(levels.back()));
  if (levels.size() == 1) return;
  for (std::size_t level = levels.size() - 1; level-- > 0;) {
    interpolateVoids(levels[level], levels[level + 1]);
    relax(levels[level]);
    levels.pop_back();
  }
  for (std::size_t k = 0; k < grid.heights.size(); ++k) {
    if (levels[0].is_void[k] != 0)
      grid.heights[k] = static_cast<std::int32_t>(std::lround(levels[0].heights[k]));
  }
}

}  // namespace

std::uint64_t fillVoidPosts(RawGrid& grid, std::span<const std::uint8_t> covered) {
  const auto voids =
      static_cast<std::uint64_t>(std::count(grid.valid.begin(), grid.valid.end(), std::uint8_t{0}));
  if (voids == 0 || voids == grid.valid.size()) return 0;
  stretch(grid, covered);
  std::uint64_t kept = 0;
  std::size_t post = 0;
  for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
    for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column, ++post) {
      if (grid.valid[post] != 0) continue;
      if (!covered.empty() && isCoveredAround(grid, covered, column, row)) {
        grid.heights[post] = 0;
        ++kept;
        continue;
      }
      grid.valid[post] = 1;
      if (!grid.void_kinds.empty()) grid.void_kinds[post] = 0;
    }
  }
  if (kept == 0) {
    grid.valid.clear();
    grid.void_kinds.clear();
    grid.header.sentinels.clear();
  }
  return voids - kept;
}

}  // namespace deltaz
