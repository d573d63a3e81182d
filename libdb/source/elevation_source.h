// Reads source DEMs through GDAL and places their posts on grids, without resampling unless asked to: posts
// are where the source says they are (the centre of a GDAL pixel, whether the file calls itself pixel-is-area
// or pixel-is-point), and every stored value comes back from its height exactly wherever a quantum of at
// least 1 mm allows it.
//
// Sources with the same reference system, spacing and phase that touch or overlap become one grid: where they
// overlap the earlier named one wins, and a void never wins over a height. All others are grids of their own.
// A grid that goes round the Earth with each meridian once has its first column again at its end.
// What is not read is refused, saying why: rotated rasters, colour tables, several bands without a choice of
// one, ... Errors: kCannotAccess (missing, unreadable, out of memory), kInvalid (not a raster, truncated, all
// void, ...), kUsage (no CRS, wrong option). GDAL's exceptions and messages end here. Cost: all posts in
// memory. Thread-safety: one thread per call.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/area.h"
#include "formats/error.h"
#include "formats/file_system.h"
#include "formats/patch_lattice.h"

namespace deltaz {

// Degrees; west > east crosses the antimeridian.
struct SourceBounds {
  double west = 0, south = 0, east = 0, north = 0;
};

// Filled are voids over which no other grid of the area has a surface.
enum class VoidPolicy : std::uint8_t { kKeep, kFill };

// A spacing of posts as people name it.
struct PostSpacing {
  double value = 0;          // > 0
  bool arc_seconds = false;  // else units of the projection (metres for "30m")
};

struct SourceOptions {
  // Reference system of the sources, in any form GDAL takes. Empty: what the sources say, and one that says
  // nothing is refused. Where a source says something else this wins, with a warning.
  std::string crs = {};
  int band = 0;                          // 0: the one band of elevations there is
  std::optional<double> nodata = {};     // stored value that means void; wins over what the source declares
  std::optional<Rational> quantum = {};  // metres; none: found so that nothing is lost
  std::optional<SourceBounds> bounds = {};  // keep only posts inside, outwards to the next post
  // "source": the sources' own posts. "geodetic" or a reference system: resampled to that.
  std::string grid = "source";
  std::optional<PostSpacing> spacing = {};  // resampled to that; none: the source's own, or one like it
  // A reference system whose datum all grids are to refer to. Empty: that of `grid` if it names one, else the
  // first source's.
  std::string datum = {};
  VoidPolicy voids = VoidPolicy::kKeep;
  bool allow_ballpark = false;  // accept a change of datum that can only be guessed, with a warning
  // Sources known from here (name and content) come in this order and before all others, however they were
  // named: to read again what an area was built from.
  std::vector<SourceDescription> order = {};
  bool join = true;  // false: one grid a raster, whatever lattice they share
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

// The grids of one gaming area, the one drawn on top first: finer before coarser, then as named. All refer to
// one datum and ellipsoid.
struct SourceArea {
  std::vector<RawGrid> grids;
  std::vector<std::string> warnings;  // one line each
  std::uint64_t filled_posts = 0;     // voids that were given a height
};

Result<SourceArea> readElevationSources(std::span<const std::string> paths, const SourceOptions& options);

// One source that makes one grid; kInvalid if it makes several.
Result<RawGrid> readElevationSource(const std::string& path, const SourceOptions& options);

}  // namespace deltaz
