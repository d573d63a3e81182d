// Databases of grids made from a seed (libdb/source/synthetic_grid.h), in memory.
#pragma once

#include <string>

#include "libdb/build/build_terrain.h"
#include "libdb/source/synthetic_grid.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {

inline const std::string kMemoryDatabasePath = "/folder/area.dz";

// A file system that holds the database of `grid` at `path` and nothing else. Throws std::runtime_error with
// the builder's message if it cannot be built.
MemoryFileSystem buildInMemory(const RawGrid& grid, const BuildOptions& options = {},
                               const std::string& path = kMemoryDatabasePath);

}  // namespace deltaz
