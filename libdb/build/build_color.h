// Adds a colour map to a database: from images, from a ramp over the heights, from a raster of classes, or by
// rule. The terrain's files are not touched; the map appears whole or not at all.
//
// Every grid gets a pyramid of texels of its own (libdb/build/color_pyramid.h): with images as deep as they
// are fine (the last level is the first whose texels are no larger than the pixels there), else to one texel
// a cell. The bytes do not depend on the number of threads. Errors: kUsage, naming the option; those of
// reading sources and database and of writing.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/error.h"
#include "formats/file_system.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

struct ColorBuildOptions {
  std::string name;
  // Exactly one of the four.
  std::vector<std::string> images = {};  // the first lies on top
  std::string ramp = {};                 // file as gdaldem color-relief takes it
  std::string classes = {};              // raster
  std::string synthetic = {};            // "natural" or "winter"

  std::string legend = {};                // of `classes`; empty: the raster's own colour table
  std::optional<PostSpacing> texel = {};  // the last level is the first with texels no larger
  std::string crs = {};                   // of images and classes that do not say, or say wrongly
  std::optional<double> nodata = {};
  bool allow_ballpark = false;
  bool overwrite = false;  // replace a map of this name
  int threads = 0;         // 0: as many as the machine has
  // Called from time to time with a phase name and the fraction done; may be empty.
  std::function<void(std::string_view phase, double fraction)> progress = {};
  // Semantic options for the provenance.
  std::vector<std::pair<std::string, std::string>> provenance = {};
};

struct ColorBuildSummary {
  std::uint64_t nodes = 0;
  int finest_level = 0, coarsest_level = 0;  // over all grids
  std::uint64_t bytes = 0;                   // of the new file
  std::vector<std::string> warnings;         // one line each
};

Result<ColorBuildSummary> buildColor(const FileSystem& files, const std::string& target,
                                     const ColorBuildOptions& options);

}  // namespace deltaz
