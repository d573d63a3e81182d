// The sources of --against, read as the database says it read them: same band, nodata value, quantum, datum
// and reference system, which stand in its provenance.
#pragma once

#include <span>
#include <string>

#include "libdb/source/elevation_source.h"

namespace deltaz {

// `crs` wins over what the database says, if it is not empty. A database that cannot be opened says nothing.
Result<SourceArea> readAgainst(std::span<const std::string> paths, const std::string& crs,
                               const std::string& area);

}  // namespace deltaz
