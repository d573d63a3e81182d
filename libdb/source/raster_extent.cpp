#include "libdb/source/raster_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

#include "libdb/source/grid_surface.h"
#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

constexpr int kOutlinePoints = 256;  // along each side of a raster
constexpr std::int64_t kInteriorPoints = 32;
// There and back again ends this close to the start.
constexpr double kWayBack = 0.5;  // posts
// Where meridians meet there is no longitude.
constexpr double kAtPole = 1e-9;  // degrees
// Intervals of longitude that leave no more than this between them go all the way round.
constexpr double kNoGap = 1e-9;  // degrees
// A projection has a pole at one point if those of all meridians lie this close together.
constexpr double kOnePoint = 1e-3;  // posts

struct Outline {
  std::vector<double> x, y;
};

// Once round the raster.
Outline outlineOf(const GridHeader& header, const GridLattice& lattice) {
  Outline outline;
  const std::int64_t columns = header.x_axis.count - 1, rows = header.y_axis.count - 1;
  const auto add = [&](std::int64_t column, std::int64_t row) {
    outline.x.push_back(lattice.xAt(column));
    outline.y.push_back(lattice.yAt(row));
  };
  for (int k = 0; k < kOutlinePoints; ++k) add(columns * k / kOutlinePoints, 0);
  for (int k = 0; k < kOutlinePoints; ++k) add(columns, rows * k / kOutlinePoints);
  for (int k = kOutlinePoints; k > 0; --k) add(columns * k / kOutlinePoints, rows);
  for (int k = kOutlinePoints; k > 0; --k) add(0, rows * k / kOutlinePoints);
  return outline;
}

// Whether the pole of this latitude is a point of a projected raster's plane, and lies in the raster.
bool holdsPole(const SourceRaster& raster, const GridLattice& lattice, const CoordinateChange& from_target,
               double latitude) {
  std::array<double, 4> x = {0, 90, 180, -90}, y = {latitude, latitude, latitude, latitude};
  if (!raster.system.projected || !from_target.apply(x, y)) return false;
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = lattice.column(x[k]);
    y[k] = lattice.row(y[k]);
  }
  const auto [x_low, x_high] = std::minmax_element(x.begin(), x.end());
  const auto [y_low, y_high] = std::minmax_element(y.begin(), y.end());
  const GridHeader& header = raster.grid.header;
  return *x_high - *x_low < kOnePoint && *y_high - *y_low < kOnePoint && x[0] > -kOnePoint &&
         y[0] > -kOnePoint && x[0] < static_cast<double>(header.x_axis.count - 1) + kOnePoint &&
         y[0] < static_cast<double>(header.y_axis.count - 1) + kOnePoint;
}

// Whether a projection takes all of a raster to places of its own, from which there is a way back: far from
// their middle many fold the Earth over itself.
bool isOneToOne(const SourceRaster& raster, const GridLattice& lattice, const CoordinateChange& to_target,
                const CoordinateChange& from_target) {
  const std::int64_t columns = raster.grid.header.x_axis.count - 1;
  const std::int64_t rows = raster.grid.header.y_axis.count - 1;
  const bool geographic = !raster.system.projected;
  std::vector<double> column, row, x, y;
  for (std::int64_t j = 0; j <= kInteriorPoints; ++j) {
    for (std::int64_t i = 0; i <= kInteriorPoints; ++i) {
      const std::int64_t at_column = columns * i / kInteriorPoints, at_row = rows * j / kInteriorPoints;
      if (geographic && std::abs(lattice.yAt(at_row)) > 90 - kAtPole) continue;
      column.push_back(static_cast<double>(at_column));
      row.push_back(static_cast<double>(at_row));
      x.push_back(lattice.xAt(at_column));
      y.push_back(lattice.yAt(at_row));
    }
  }
  if (!to_target.apply(x, y) || !from_target.apply(x, y)) return false;
  const double turn = geographic ? 360 / raster.grid.header.x_axis.spacing : 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    double off = lattice.column(x[k]) - column[k];
    if (geographic) off -= turn * std::round(off / turn);
    if (std::abs(off) > kWayBack || std::abs(lattice.row(y[k]) - row[k]) > kWayBack) return false;
  }
  return true;
}

Result<CoordinateExtent> extentOfOne(const SourceRaster& raster, const ReferenceSystem& system,
                                     bool allow_ballpark) {
  const GridLattice lattice(raster.grid.header, raster.system);
  Outline outline = outlineOf(raster.grid.header, lattice);
  const std::vector<double> own_x = outline.x;
  DELTAZ_TRY_ASSIGN(const CoordinateChange change,
                    CoordinateChange::between(raster.system, system, allow_ballpark, raster.path));
  DELTAZ_TRY_ASSIGN(const CoordinateChange back,
                    CoordinateChange::between(system, raster.system, allow_ballpark, raster.path));
  if (!change.apply(outline.x, outline.y) ||
      (system.projected && !isOneToOne(raster, lattice, change, back))) {
    return refusedSource(raster.path, fmt::format("the source reaches outside '{}'", system.name), {},
                         "Choose another --grid, or a part with --bounds");
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  CoordinateExtent extent{kInfinity, kInfinity, -kInfinity, -kInfinity};
  double last = outline.x.front();
  for (std::size_t k = 0; k < outline.x.size(); ++k) {
    extent.south = std::min(extent.south, outline.y[k]);
    extent.north = std::max(extent.north, outline.y[k]);
    double x = outline.x[k];
    if (!system.projected) {
      const bool geographic = !raster.system.projected;
      if (!geographic && std::abs(outline.y[k]) > 90 - kAtPole) continue;
      // Followed round the outline; degrees of another datum differ by seconds, not by a turn.
      x -= 360 * std::round((x - (geographic ? own_x[k] : last)) / 360);
      last = x;
    }
    extent.west = std::min(extent.west, x);
    extent.east = std::max(extent.east, x);
  }
  if (system.projected) return extent;
  for (const double pole : {-90.0, 90.0}) {
    if (!holdsPole(raster, lattice, back, pole)) continue;
    // All meridians end in it.
    extent.west = -180;
    extent.east = 180;
    (pole < 0 ? extent.south : extent.north) = pole;
  }
  return extent;
}

// The shortest way along a circle of latitude past all intervals.
void joinLongitudes(std::vector<CoordinateExtent>& extents, CoordinateExtent& all) {
  for (CoordinateExtent& extent : extents) {
    const double turns = 360 * std::floor((extent.west + 180) / 360);
    extent.west -= turns;
    extent.east -= turns;
  }
  std::sort(extents.begin(), extents.end(),
            [](const CoordinateExtent& a, const CoordinateExtent& b) { return a.west < b.west; });
  double reached = extents.front().east, widest = kNoGap;
  all.west = -180;
  all.east = 180;
  for (std::size_t k = 0; k < extents.size(); ++k) {
    reached = std::max(reached, extents[k].east);
    const bool is_last = k + 1 == extents.size();
    const double next = is_last ? extents.front().west + 360 : extents[k + 1].west;
    if (next - reached <= widest) continue;
    widest = next - reached;
    all.west = is_last ? extents.front().west : next;
    all.east = is_last ? reached : reached + 360;
  }
}

}  // namespace

Result<CoordinateExtent> extentOf(std::span<const SourceRaster> rasters, const ReferenceSystem& system,
                                  bool allow_ballpark) {
  std::vector<CoordinateExtent> extents;
  for (const SourceRaster& raster : rasters) {
    DELTAZ_TRY_ASSIGN(const CoordinateExtent one, extentOfOne(raster, system, allow_ballpark));
    extents.push_back(one);
  }
  CoordinateExtent all = extents.front();
  for (const CoordinateExtent& extent : extents) {
    all.west = std::min(all.west, extent.west);
    all.east = std::max(all.east, extent.east);
    all.south = std::min(all.south, extent.south);
    all.north = std::max(all.north, extent.north);
  }
  if (!system.projected) joinLongitudes(extents, all);
  return all;
}

}  // namespace deltaz
