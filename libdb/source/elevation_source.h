// Reads a source DEM through GDAL and places its posts on a grid, without resampling: posts are where the
// source says they are (the centre of a GDAL pixel, whether the file calls itself pixel-is-area or
// pixel-is-point).
//
// This version reads one integer raster in geodetic coordinates, north-up or south-up. What it does not read
// it refuses, saying why: rotated, projected, floating point, per-dataset masks, several bands. Errors:
// kCannotAccess (missing, unreadable), kInvalid (not a raster, truncated, all void, ...), kUsage (no CRS).
// GDAL's exceptions and messages end here. Thread-safety: one thread per call.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/error.h"
#include "formats/file_system.h"
#include "formats/patch_lattice.h"

namespace deltaz {

struct SourceOptions {
  std::string crs;  // used where the source has none; empty: refuse such a source
};

// A whole grid of posts in memory: the report's raw gaming area.
struct RawGrid {
  GridHeader header;                  // level_count is not yet set
  std::vector<std::int32_t> heights;  // y_axis.count rows of x_axis.count posts, from the south-west, quanta
  std::vector<std::uint8_t> valid;    // 1 or 0, same shape; empty if every post is valid
  // Index into header.sentinels of each void post, same shape; empty if all are 0.
  std::vector<std::uint8_t> void_kinds;
  std::shared_ptr<const PatchLattice> patches;  // projected grids only
  bool isValid(std::int64_t column, std::int64_t row) const {
    return valid.empty() || valid[static_cast<std::size_t>(row * header.x_axis.count + column)] != 0;
  }
  std::int32_t height(std::int64_t column, std::int64_t row) const {
    return heights[static_cast<std::size_t>(row * header.x_axis.count + column)];
  }
};

Result<RawGrid> readElevationSource(const std::string& path, const SourceOptions& options);

}  // namespace deltaz
