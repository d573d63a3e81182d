// One raster as a raw grid of its own: everything about it that other sources do not matter for. Errors and
// thread-safety as elevation_source.h.
#pragma once

#include <string>
#include <vector>

#include "libdb/source/elevation_source.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

struct SourceRaster {
  std::string path;
  ReferenceSystem system;
  // kind is "geodetic" or "projected" as the system is; no patches yet.
  RawGrid grid;
};

// Reads the raster at `path`, as GDAL opens it. Adds what the user should know to `warnings`.
Result<SourceRaster> readSourceRaster(const std::string& path, const SourceOptions& options,
                                      std::vector<std::string>& warnings);

}  // namespace deltaz
