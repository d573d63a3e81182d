// Builds a database from a grid of posts: leaves at global multiples, every coarser level as a subset, the
// ring, bounds, normal cones and geometric errors, and publishes it whole or not at all.
//
// The result does not depend on the number of threads. Cost: a few passes over the posts per level; memory
// about six bytes a post beside the grid itself.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "formats/error.h"
#include "formats/file_system.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

struct BuildOptions {
  int leaf_cells = 64;     // power of two, 8 .. kMaximumLeafCells
  bool overwrite = false;  // replace an existing deltaz database (never anything else)
  int threads = 0;         // 0: as many as the machine has
  // Called from time to time with a phase name and the fraction done (0 .. 1, never falling); may be empty.
  std::function<void(std::string_view phase, double fraction)> progress = {};
};

struct BuildSummary {
  std::uint32_t nodes = 0;
  int levels = 0;
  std::uint64_t posts = 0, voids = 0;
  std::uint64_t bytes = 0;   // of all files published
  double largest_error = 0;  // metres, of the coarsest level
};

Result<BuildSummary> buildTerrain(const FileSystem& files, const RawGrid& grid, const std::string& target,
                                  const BuildOptions& options);

}  // namespace deltaz
