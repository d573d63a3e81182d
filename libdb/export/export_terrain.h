// Writes a grid of a database back as GeoTIFF: level 0 post for post and void for void as the source had
// them, with its georeferencing, sentinels, data type, unit, scale and offset. A grid joined from several
// sources is written whole, with the first one's properties and one sentinel; a resampled one as Float32
// metres. Coarser levels get a georeferencing of their own.
//
// The file appears under its name complete or not at all. Errors: kUsage (target exists, no such level or
// grid), kCannotAccess, and whatever reading the database reports.
#pragma once

#include <string>

#include "libdb/access/database.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

struct ExportOptions {
  int grid = 0;
  int level = 0;
  bool overwrite = false;
};

Status exportTerrain(const Database& database, const std::string& target, const ExportOptions& options);

// All posts of one level of a grid in memory. At level > 0 the header's axes describe that level.
Result<RawGrid> readGrid(const Database& database, int grid, int level);

}  // namespace deltaz
