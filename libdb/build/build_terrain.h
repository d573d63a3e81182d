// Builds a database from grids of posts: leaves at global multiples, every coarser level as a subset, the
// ring, bounds, normal cones, geometric and coverage errors, and publishes it whole or not at all.
//
// Each grid becomes a tree of its own under the area's cluster node, in the given order: where grids overlap,
// readers take the earlier one. Records and terrain stand breadth first over all grids, so that the first
// page of nodes is the whole area, coarsely. All grids must share one ellipsoid (kUsage). A grid of kind
// "projected" brings its control points along (RawGrid::patches) and gets a file of them.
//
// The result does not depend on the number of threads. Cost: a few passes over the posts per level; memory
// about six bytes a post beside the grids themselves, ten more where there are voids.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  // Further semantic options for the provenance, beside those above that are; names must differ.
  std::vector<std::pair<std::string, std::string>> provenance = {};
};

struct BuildSummary {
  std::uint32_t nodes = 0;
  int levels = 0;  // of the grid with most
  std::uint64_t posts = 0, voids = 0;
  std::uint64_t bytes = 0;   // of all files published
  double largest_error = 0;  // metres, of the grids' coarsest levels
};

Result<BuildSummary> buildTerrain(const FileSystem& files, std::span<const RawGrid> grids,
                                  const std::string& target, const BuildOptions& options);

Result<BuildSummary> buildTerrain(const FileSystem& files, const RawGrid& grid, const std::string& target,
                                  const BuildOptions& options);

}  // namespace deltaz
