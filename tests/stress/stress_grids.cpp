#include "tests/stress/stress_grids.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "formats/terrain_segment.h"
#include "libdb/access/earth.h"
#include "tests/support/small_area.h"

namespace deltaz {
namespace {

SyntheticGridOptions squareAt(double south, double west, Rational spacing, std::int64_t posts) {
  SyntheticGridOptions options;
  options.south = south;
  options.west = west;
  options.spacing_latitude = options.spacing_longitude = spacing;
  options.columns = options.rows = posts;
  return options;
}

NamedGrid on(const std::string& name, const EllipsoidShape& ellipsoid, std::int32_t highest,
             Rational quantum) {
  SyntheticGridOptions options = squareAt(12, 30, {60, 1}, 49);
  options.lowest = 0;
  options.highest = highest;
  options.quantum = quantum;
  RawGrid grid = syntheticGrid(options);
  grid.header.ellipsoid = ellipsoid;
  return {name, std::move(grid), 16};
}

}  // namespace

void setPlainAxis(GridAxis& axis, const AxisOrigin& origin, double first, double spacing,
                  std::int64_t count) {
  axis.exact_spacing.reset();
  axis.spacing = spacing;
  const double posts = (first - origin.coordinate) / spacing;
  axis.first = static_cast<std::int64_t>(std::floor(posts));
  axis.phase = 0;
  axis.count = count;
}

std::vector<NamedGrid> extremeGrids() {
  std::vector<NamedGrid> grids;
  const auto add = [&](const std::string& name, const SyntheticGridOptions& options, int leaf = 16) {
    grids.push_back({name, syntheticGrid(options), leaf});
  };
  add("north_pole", squareAt(89.5, 10, {30, 1}, 61));
  add("south_pole", squareAt(-90, -75, {30, 1}, 61));
  SyntheticGridOptions ring = squareAt(88, -180, {300, 1}, 25);
  ring.spacing_longitude = {7200, 1};
  ring.columns = 181;
  add("north_pole_all_round", ring);
  // As near as a row comes that is not on the pole itself.
  add("beside_the_north_pole", squareAt(89.5, 10, {30, 1}, 60));
  add("beside_the_south_pole", squareAt(-90 + 3.0 / 3600, -75, {3, 1}, 61));
  add("antimeridian", squareAt(-17, 179.75, {15, 1}, 121));
  SyntheticGridOptions thin = squareAt(46, 7, {3, 1}, 2);
  thin.columns = 10000;
  add("two_rows_of_ten_thousand", thin, 64);
  std::swap(thin.columns, thin.rows);
  add("two_columns_of_ten_thousand", thin, 64);
  SyntheticGridOptions survey_feet = squareAt(40, -105, {1, 1}, 65);
  survey_feet.quantum = {1200, 3937};
  add("survey_feet", survey_feet);

  SyntheticGridOptions voids = squareAt(46, 7, {3, 1}, 65);
  for (const auto& [name, pattern] : {std::pair{"scattered_voids", VoidPattern::kScattered},
                                      std::pair{"west_half_void", VoidPattern::kWestHalf}}) {
    voids.voids = pattern;
    add(name, voids);
  }
  voids.voids = VoidPattern::kNone;
  NamedGrid single{"single_valid_post", syntheticGrid(voids), 16};
  single.grid.valid.assign(single.grid.heights.size(), 0);
  single.grid.valid[32 * 65 + 32] = 1;
  grids.push_back(std::move(single));

  // Posts 0.1 mm apart, 2 mm of relief over 3 cm. Leaves of 256 cells, the least whose numbers fit node
  // records all round the Earth at this spacing.
  SyntheticGridOptions least = squareAt(46, 7, {3, 1}, 300);
  least.lowest = 0;
  least.highest = 200;
  least.quantum = {1, 100000};
  NamedGrid closest{"least_spacing", syntheticGrid(least), 256};
  setPlainAxis(closest.grid.header.x_axis, kLongitudeOrigin, 7, kLeastSpacingDegrees, 300);
  setPlainAxis(closest.grid.header.y_axis, kLatitudeOrigin, 46, kLeastSpacingDegrees, 300);
  grids.push_back(std::move(closest));

  grids.push_back({"projected", projectedGrid(140, 100, 30), 16});
  grids.push_back(on("sphere_of_one_metre", {1, 0}, 1000, {1, 1000000}));
  grids.push_back(on("the_largest_ellipsoid", {1e8, 20}, 20000, {1, 1}));
  grids.push_back(on("very_flat_ellipsoid", {6378137, 1.5}, 2000, {1, 1}));
  return grids;
}

TerrainTile wholeTile(const RawGrid& grid) {
  TerrainTile tile;
  tile.first_column = grid.header.x_axis.first;
  tile.first_row = grid.header.y_axis.first;
  tile.columns = static_cast<int>(grid.header.x_axis.count);
  tile.rows = static_cast<int>(grid.header.y_axis.count);
  const std::size_t size =
      static_cast<std::size_t>(tile.columns + 2) * static_cast<std::size_t>(tile.rows + 2);
  tile.heights.assign(size, 0);
  tile.valid.assign(size, 0);
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      tile.heights[tile.index(i, j)] = grid.height(i, j);
      tile.valid[tile.index(i, j)] = grid.isValid(i, j) ? 1 : 0;
    }
  }
  return tile;
}

TerrainTile columnsOf(const TerrainTile& tile, int first, int columns) {
  TerrainTile part = tile;
  part.first_column += first;
  part.columns = columns;
  part.heights.clear();
  part.valid.clear();
  part.void_kinds.clear();
  for (int j = -1; j <= tile.rows; ++j) {
    for (int i = first - 1; i <= first + columns; ++i) {
      part.heights.push_back(tile.height(i, j));
      part.valid.push_back(tile.isValid(i, j) ? 1 : 0);
    }
  }
  return part;
}

RawGrid alternatingGrid(std::int32_t height, Rational quantum) {
  SyntheticGridOptions options;
  options.spacing_latitude = options.spacing_longitude = {3, 1};
  options.columns = options.rows = 33;
  options.quantum = quantum;
  RawGrid grid = syntheticGrid(options);
  for (std::int64_t row = 0; row < 33; ++row) {
    for (std::int64_t column = 0; column < 33; ++column)
      grid.heights[static_cast<std::size_t>(row * 33 + column)] = (row + column) % 3 == 0 ? height : -height;
  }
  return grid;
}

RawGrid projectedGrid(std::int64_t columns, std::int64_t rows, double spacing) {
  constexpr double kLatitude = 46, kLongitude = 7, kRadian = std::numbers::pi / 180;
  SyntheticGridOptions options;
  options.columns = columns;
  options.rows = rows;
  RawGrid grid = syntheticGrid(options);
  GridHeader& header = grid.header;
  header.kind = "projected";
  setPlainAxis(header.x_axis, kProjectedOrigin, 0, spacing, columns);
  setPlainAxis(header.y_axis, kProjectedOrigin, 0, spacing, rows);
  PatchPlacement placement;
  placement.cells = 64;
  placement.columns = (columns + 62) / 64;
  placement.rows = (rows + 62) / 64;
  header.patches = placement;
  auto lattice = std::make_shared<PatchLattice>();
  lattice->placement = placement;
  const double radius = header.ellipsoid.semi_major_axis;
  for (std::int64_t j = 0; j < lattice->pointRows(); ++j) {
    for (std::int64_t i = 0; i < lattice->pointColumns(); ++i) {
      const double x = static_cast<double>(i * lattice->step()) * spacing,
                   y = static_cast<double>(j * lattice->step()) * spacing;
      const Vector3 p = toEarthCentred(
          header.ellipsoid, {kLatitude + y / radius / kRadian,
                             kLongitude + x / (radius * std::cos(kLatitude * kRadian)) / kRadian, 0});
      lattice->controls.insert(lattice->controls.end(), {p.x, p.y, p.z});
    }
  }
  grid.patches = std::move(lattice);
  return grid;
}

NamedGrid hills() {
  return {"hills", syntheticGrid(smallArea()), 16};
}

}  // namespace deltaz
