// Gives void posts heights between those of their neighbours (inverse distances, by GDALFillNodata).
#pragma once

#include <cstdint>
#include <string>

#include "formats/error.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

// Fills the voids of a grid that has some height; returns how many. kInternal if GDAL fails.
Result<std::uint64_t> fillVoidPosts(RawGrid& grid, const std::string& path);

}  // namespace deltaz
