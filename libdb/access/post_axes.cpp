#include "libdb/access/post_axes.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/vector_lists.h"

namespace deltaz {

PostAxes::PostAxes(const GridHeader& grid)
    : ellipsoid_(grid.ellipsoid), x_axis_(grid.x_axis), y_axis_(grid.y_axis) {}

template <typename Block>
template <typename Make>
const Block& PostAxes::Blocks<Block>::at(int level, std::int64_t number, const Make& make) const {
  // Levels are fewer than 32 and numbers of blocks far below 2^58.
  const std::uint64_t key = static_cast<std::uint64_t>(number) << 5 | static_cast<std::uint64_t>(level);
  {
    const std::shared_lock lock(mutex);
    if (const auto found = made.find(key); found != made.end()) return *found->second;
  }
  // Two threads may make the same block; the first to come keeps its own.
  auto block = std::make_unique<Block>();
  make(*block);
  const std::unique_lock lock(mutex);
  return *made.emplace(key, std::move(block)).first->second;
}

void PostAxes::rows(int level, PostRange range, std::vector<RowTerms>& terms) const {
  terms.clear();
  const std::int64_t step = std::int64_t{1} << level;
  const auto latitude = [&](std::int64_t row) { return postLatitude(y_axis_, row * step); };
  for (std::int64_t row = range.begin; row < range.end;) {
    const std::int64_t number = floorDivide(row, kBlock), first = number * kBlock;
    const RowBlock& block = rows_.at(level, number, [&](RowBlock& made) {
      for (std::int64_t k = 0; k < kBlock; ++k) {
        const double here = latitude(first + k), next = latitude(first + k + 1);
        made[static_cast<std::size_t>(k)] = {rowConstants(ellipsoid_, here), rowStep(ellipsoid_, here, next)};
      }
    });
    for (const std::int64_t end = std::min(range.end, first + kBlock); row < end; ++row)
      terms.push_back(block[static_cast<std::size_t>(row - first)]);
  }
}

void PostAxes::columns(int level, PostRange range, ColumnTerms& terms) const {
  for (std::vector<double>* list : {&terms.cosine, &terms.sine, &terms.step_cosine, &terms.step_sine})
    resizePadded(*list, static_cast<std::size_t>(range.size()));
  const std::int64_t step = std::int64_t{1} << level;
  const auto longitude = [&](std::int64_t column) { return postLongitude(x_axis_, column * step); };
  std::size_t out = 0;
  for (std::int64_t column = range.begin; column < range.end;) {
    const std::int64_t number = floorDivide(column, kBlock), first = number * kBlock;
    const ColumnBlock& block = columns_.at(level, number, [&](ColumnBlock& made) {
      for (std::int64_t k = 0; k < kBlock; ++k) {
        const double here = longitude(first + k), next = longitude(first + k + 1);
        made.at[static_cast<std::size_t>(k)] = columnConstants(here);
        made.step[static_cast<std::size_t>(k)] = columnStep(here, next);
      }
    });
    for (const std::int64_t end = std::min(range.end, first + kBlock); column < end; ++column, ++out) {
      const auto k = static_cast<std::size_t>(column - first);
      terms.cosine[out] = block.at[k].cosine;
      terms.sine[out] = block.at[k].sine;
      terms.step_cosine[out] = block.step[k].cosine;
      terms.step_sine[out] = block.step[k].sine;
    }
  }
}

}  // namespace deltaz
