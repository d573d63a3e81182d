// The options of `dbbuild color` as texts, from a command line or a build file, and what they do.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "libdb/build/build_color.h"
#include "tools/common/command_line.h"

namespace deltaz {

// Members are named after the options, --image and so on.
struct ColorOptionTexts {
  std::string name;
  std::vector<std::string> image;
  std::string ramp, classes, legend, synthetic, texel, crs, nodata;
  bool allow_ballpark = false;
  bool remove = false;

  void addTo(CLI::App& app);
  // kUsage, naming the option. Threads, overwriting and progress are left alone. Pre: not `remove`.
  Result<ColorBuildOptions> parse() const;
};

// Does what `dbbuild color` does with these options on the database `area`, output and warnings included;
// returns the exit code.
Result<int> runColor(const std::string& area, const ColorOptionTexts& texts, const CommonOptions& common);

}  // namespace deltaz
