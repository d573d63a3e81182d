// What an opened GDAL dataset says about itself, told alike by elevations and colours. Thread-safety: as the
// dataset's.
#pragma once

#include <string>
#include <vector>

#include "libdb/source/reference_system.h"

class GDALDataset;

namespace deltaz {

// The reference system of the coordinates: the one given (`crs`, any form GDAL takes), else the dataset's
// own. Adds to `warnings` where they differ. kUsage, naming --crs, if there is neither.
Result<ReferenceSystem> statedSystem(GDALDataset& dataset, const std::string& path, const std::string& crs,
                                     std::vector<std::string>& warnings);

// The files a virtual raster is made of; empty for others.
std::vector<std::string> membersOfVirtual(GDALDataset& dataset);

}  // namespace deltaz
