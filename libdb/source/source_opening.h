// Finds the rasters behind a path a user named: a file GDAL reads, or every raster inside a zip archive,
// folders in it included. Errors and thread-safety as elevation_source.h.
#pragma once

#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/hash.h"

namespace deltaz {

// Paths as GDAL opens them, in the order of their names; the path itself if it is a raster.
Result<std::vector<std::string>> rastersBehind(const std::string& path);

// Hash of a source's bytes; of a virtual raster those of its members too, in GDAL's order (`members`).
Result<Hash128> hashOfContent(const std::string& path, const std::vector<std::string>& members);

}  // namespace deltaz
