#include "libdb/source/area_datum.h"

#include <string>

namespace deltaz {

std::optional<ReferenceSystem> datumOf(const AreaHeader& area) {
  const std::string where(kAreaFileName);
  for (const GridHeader& grid : area.grids) {
    const Result<ReferenceSystem> system = parseReferenceSystem(grid.crs_wkt, where, grid.coordinate_epoch);
    if (!system.ok()) continue;
    const Result<ReferenceSystem> below = geographicOf(system.value(), where);
    // A geodetic grid is in the area's datum. Of a projected one the header has the area's, and the reference
    // system the source's own.
    if (below.ok() && (grid.kind == "geodetic" || below.value().horizontal_datum == grid.horizontal_datum))
      return below.value();
  }
  return std::nullopt;
}

}  // namespace deltaz
