// The options that say how sources become grids: adding them to a command line, reading them from it, and
// telling them as provenance, so that dbcheck can read the same sources in the same way.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "libdb/source/elevation_source.h"
#include "tools/common/command_line.h"

namespace deltaz {

class SourceOptionTexts {
 public:
  void addTo(CLI::App& app);
  // kUsage, naming the option.
  Result<SourceOptions> parse() const;
  // Name and value of every option that was given and changes what is built.
  std::vector<std::pair<std::string, std::string>> provenance() const;

 private:
  std::string crs_, band_, nodata_, quantum_ = "auto", bounds_, grid_ = "source", spacing_, voids_ = "keep";
  bool allow_ballpark_ = false;
};

}  // namespace deltaz
