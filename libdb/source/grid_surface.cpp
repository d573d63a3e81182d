#include "libdb/source/grid_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

namespace {

// Positions next to a post are taken for it, so that its neighbours' voids do not matter.
double snapped(double share) {
  if (std::abs(share) < kOnPost) return 0;
  return std::abs(1 - share) < kOnPost ? 1 : share;
}

}  // namespace

std::optional<double> GridSurface::heightAt(double x, double y) const {
  const auto columns = grid_.header.x_axis.count, rows = grid_.header.y_axis.count;
  if (!(x >= -kOnPost && y >= -kOnPost && x <= static_cast<double>(columns - 1) + kOnPost &&
        y <= static_cast<double>(rows - 1) + kOnPost))
    return std::nullopt;
  const auto column = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(x)), 0, columns - 2);
  const auto row = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(y)), 0, rows - 2);
  const double u = snapped(x - static_cast<double>(column)), v = snapped(y - static_cast<double>(row));
  const std::array<double, 4> weights = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (weights[k] == 0) continue;
    const auto i = column + static_cast<std::int64_t>(k % 2), j = row + static_cast<std::int64_t>(k / 2);
    if (!grid_.isValid(i, j)) return std::nullopt;
    sum += weights[k] * static_cast<double>(grid_.height(i, j));
  }
  return sum * quantum_;
}

GridLattice::GridLattice(const GridHeader& header, const ReferenceSystem& system)
    : header_(header), geographic_(!system.projected) {
  if (header.kind == "geodetic") {
    of_x_ = kLongitudeOrigin;
    of_y_ = kLatitudeOrigin;
  }
  west_ = xAt(0);
  south_ = yAt(0);
  middle_ = 0.5 * (west_ + xAt(header.x_axis.count - 1));
}

double GridLattice::xAt(std::int64_t column) const {
  return postCoordinate(header_.x_axis, of_x_, header_.x_axis.first + column);
}
double GridLattice::yAt(std::int64_t row) const {
  return postCoordinate(header_.y_axis, of_y_, header_.y_axis.first + row);
}

double GridLattice::column(double x) const {
  // A longitude has many names; the one nearest to the grid counts.
  if (geographic_) x -= 360 * std::round((x - middle_) / 360);
  return (x - west_) / header_.x_axis.spacing;
}

Result<SurfaceStack> SurfaceStack::make(std::span<const PlacedGrid> grids, const ReferenceSystem& seen_from,
                                        bool allow_ballpark) {
  SurfaceStack stack;
  for (const PlacedGrid& placed : grids) {
    DELTAZ_TRY_ASSIGN(CoordinateChange change,
                      CoordinateChange::between(seen_from, placed.system, allow_ballpark, placed.path));
    stack.changes_.push_back(std::move(change));
    stack.grids_.push_back(placed);
  }
  return stack;
}

std::vector<double> SurfaceStack::heightsAt(std::span<const double> x, std::span<const double> y,
                                            std::size_t count) const {
  std::vector<double> heights(x.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t g = 0; g < count; ++g) {
    std::vector<double> their_x(x.begin(), x.end()), their_y(y.begin(), y.end());
    (void)changes_[g].apply(their_x, their_y);  // what has no counterpart is NaN
    const GridLattice lattice(grids_[g].grid->header, grids_[g].system);
    const GridSurface surface(*grids_[g].grid);
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (!std::isnan(heights[k]) || std::isnan(their_x[k])) continue;
      if (const auto height = surface.heightAt(lattice.column(their_x[k]), lattice.row(their_y[k])))
        heights[k] = *height;
    }
  }
  return heights;
}

Result<SurfaceDifference> differenceFrom(const RawGrid& made, const ReferenceSystem& system,
                                         std::span<const PlacedGrid> grids, bool allow_ballpark) {
  const GridSurface surface(made);
  const GridLattice lattice(made.header, system);
  SurfaceDifference difference;
  double sum = 0;
  for (std::size_t g = 0; g < grids.size(); ++g) {
    const RawGrid& grid = *grids[g].grid;
    DELTAZ_TRY_ASSIGN(const SurfaceStack above,
                      SurfaceStack::make(grids.first(g), grids[g].system, allow_ballpark));
    DELTAZ_TRY_ASSIGN(const CoordinateChange change,
                      CoordinateChange::between(grids[g].system, system, allow_ballpark, grids[g].path));
    const GridLattice theirs(grid.header, grids[g].system);
    const double quantum = grid.header.quantum.value();
    for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
      std::vector<double> x, y, heights;
      for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column) {
        if (!grid.isValid(column, row)) continue;
        x.push_back(theirs.xAt(column));
        y.push_back(theirs.yAt(row));
        heights.push_back(static_cast<double>(grid.height(column, row)) * quantum);
      }
      const std::vector<double> covering = above.heightsAt(x, y, above.size());
      (void)change.apply(x, y);
      for (std::size_t k = 0; k < x.size(); ++k) {
        if (std::isnan(x[k]) || !std::isnan(covering[k])) continue;
        const auto height = surface.heightAt(lattice.column(x[k]), lattice.row(y[k]));
        if (!height) continue;
        const double error = std::abs(*height - heights[k]);
        difference.largest = std::max(difference.largest, error);
        sum += error * error;
        ++difference.posts;
      }
    }
  }
  if (difference.posts > 0) difference.rms = std::sqrt(sum / static_cast<double>(difference.posts));
  return difference;
}

}  // namespace deltaz
