#include "tests/support/projected_grid.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/TransverseMercator.hpp>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

RawGrid projectedGrid(const ProjectedGridOptions& options) {
  SyntheticGridOptions heights;
  heights.columns = options.columns;
  heights.rows = options.rows;
  heights.voids = options.voids;
  heights.seed = options.seed;
  RawGrid grid = syntheticGrid(heights);
  GridHeader& header = grid.header;
  header.kind = "projected";
  header.crs_wkt = "PROJCRS[\"WGS 84 / UTM zone " + std::to_string(options.zone) + "N\"]";
  const auto axis = [&](double start, std::int64_t count) {
    GridAxis result;
    result.spacing = static_cast<double>(options.spacing);
    result.exact_spacing = Rational{options.spacing, 1};
    result.first = floorDivide(static_cast<std::int64_t>(start), options.spacing);
    result.count = count;
    return result;
  };
  header.x_axis = axis(options.easting, options.columns);
  header.y_axis = axis(options.northing, options.rows);

  PatchPlacement placement;
  placement.cells = options.patch_cells;
  const auto place = [&](const GridAxis& posts, std::int64_t& first, std::int64_t& count) {
    first = floorDivide(posts.first, placement.cells);
    count = floorDivide(posts.first + posts.count - 2, placement.cells) + 1 - first;
  };
  place(header.x_axis, placement.first_x, placement.columns);
  place(header.y_axis, placement.first_y, placement.rows);
  // Far above what degree 4 leaves over a few kilometres.
  placement.error = 1e-6;

  auto lattice = std::make_shared<PatchLattice>();
  lattice->placement = placement;
  const GeographicLib::TransverseMercator& utm = GeographicLib::TransverseMercator::UTM();
  const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
  for (std::int64_t row = 0; row < lattice->pointRows(); ++row) {
    for (std::int64_t column = 0; column < lattice->pointColumns(); ++column) {
      const auto metres = [&](std::int64_t first, std::int64_t point) {
        return static_cast<double>((first * placement.cells + point * lattice->step()) * options.spacing);
      };
      double latitude = 0, longitude = 0, x = 0, y = 0, z = 0;
      utm.Reverse(options.zone * 6 - 183, metres(placement.first_x, column) - 500000,
                  metres(placement.first_y, row), latitude, longitude);
      earth.Forward(latitude, longitude, 0, x, y, z);
      lattice->controls.insert(lattice->controls.end(), {x, y, z});
    }
  }
  header.patches = placement;
  grid.patches = lattice;
  return grid;
}

}  // namespace deltaz
