// What rasters cover in coordinates of another reference system: whatever side of the antimeridian they lie
// on, all round the Earth, and with a pole inside. Pure function. Cost: a thousand positions a raster.
#pragma once

#include <span>

#include "libdb/source/source_raster.h"

namespace deltaz {

// Units of the system. Longitudes: west in [-180, 180), east beyond it, 360 degrees apart at most.
struct CoordinateExtent {
  double west = 0, south = 0, east = 0, north = 0;
};

// Of all rasters together, the smallest there is. Pre: rasters are not empty. kInvalid if a raster reaches
// where the system has no coordinates; errors as CoordinateChange::between.
Result<CoordinateExtent> extentOf(std::span<const SourceRaster> rasters, const ReferenceSystem& system,
                                  bool allow_ballpark);

}  // namespace deltaz
