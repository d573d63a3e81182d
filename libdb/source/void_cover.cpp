#include "libdb/source/void_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "formats/terrain_segment.h"

namespace deltaz {

namespace {

// A position this far beyond a facet's edge (in posts) is on it: grids that touch were written as decimals.
constexpr double kOnEdge = 1e-6;

// Metres on the facet at a position in posts; nothing where it has a void corner that counts, or there is
// none.
std::optional<double> facetHeight(const RawGrid& grid, double x, double y) {
  const auto columns = grid.header.x_axis.count, rows = grid.header.y_axis.count;
  if (!(x >= -kOnEdge && y >= -kOnEdge && x <= static_cast<double>(columns - 1) + kOnEdge &&
        y <= static_cast<double>(rows - 1) + kOnEdge))
    return std::nullopt;
  const auto column = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(x)), 0, columns - 2);
  const auto row = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(y)), 0, rows - 2);
  const double u = std::clamp(x - static_cast<double>(column), 0.0, 1.0);
  const double v = std::clamp(y - static_cast<double>(row), 0.0, 1.0);
  const bool east = u >= v;
  const std::array<double, 3> weights = {1 - std::max(u, v), std::abs(u - v), std::min(u, v)};
  const std::array<std::array<std::int64_t, 2>, 3> corners = {
      {{column, row}, {column + (east ? 1 : 0), row + (east ? 0 : 1)}, {column + 1, row + 1}}};
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (weights[k] <= kOnEdge) continue;
    if (!grid.isValid(corners[k][0], corners[k][1])) return std::nullopt;
    sum += weights[k] * static_cast<double>(grid.height(corners[k][0], corners[k][1]));
  }
  return sum * grid.header.quantum.value();
}

// Whether a post or one of its eight neighbours is void.
bool isNearVoid(const RawGrid& grid, std::int64_t column, std::int64_t row) {
  const auto columns = grid.header.x_axis.count, rows = grid.header.y_axis.count;
  for (std::int64_t j = std::max<std::int64_t>(row - 1, 0); j <= std::min(row + 1, rows - 1); ++j) {
    for (std::int64_t i = std::max<std::int64_t>(column - 1, 0); i <= std::min(column + 1, columns - 1);
         ++i) {
      if (!grid.isValid(i, j)) return true;
    }
  }
  return false;
}

}  // namespace

Result<std::vector<std::uint8_t>> coverVoids(RawGrid& grid, const ReferenceSystem& system,
                                             std::span<const PlacedGrid> others, bool allow_ballpark) {
  std::vector<std::uint8_t> covered;
  if (grid.valid.empty() || others.empty()) return covered;
  covered.assign(grid.valid.size(), 0);
  std::vector<CoordinateChange> changes;
  std::vector<GridLattice> lattices;
  for (const PlacedGrid& other : others) {
    const bool same = sameDatum(system, other.system);
    DELTAZ_TRY_ASSIGN(CoordinateChange change,
                      CoordinateChange::between(system, other.system, same || allow_ballpark, other.path));
    changes.push_back(std::move(change));
    lattices.emplace_back(other.grid->header, other.system);
  }
  const GridLattice ours(grid.header, system);
  const double quantum = grid.header.quantum.value();
  bool some = false;
  for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
    std::vector<std::int64_t> asked;
    for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column) {
      if (isNearVoid(grid, column, row)) asked.push_back(column);
    }
    for (std::size_t g = 0; g < others.size() && !asked.empty(); ++g) {
      std::vector<double> x, y(asked.size(), ours.yAt(row));
      for (const std::int64_t column : asked) x.push_back(ours.xAt(column));
      (void)changes[g].apply(x, y);  // what has no counterpart is NaN
      std::vector<std::int64_t> left;
      for (std::size_t k = 0; k < asked.size(); ++k) {
        const auto height = facetHeight(*others[g].grid, lattices[g].column(x[k]), lattices[g].row(y[k]));
        if (!height) {
          left.push_back(asked[k]);
          continue;
        }
        const auto post = static_cast<std::size_t>(row * grid.header.x_axis.count + asked[k]);
        covered[post] = 1;
        some = true;
        constexpr double kMost = kMaximumHeightQuanta;
        if (grid.valid[post] == 0) {
          grid.heights[post] =
              static_cast<std::int32_t>(std::lround(std::clamp(*height / quantum, -kMost, kMost)));
        }
      }
      asked = std::move(left);
    }
  }
  if (!some) covered.clear();
  return covered;
}

}  // namespace deltaz
