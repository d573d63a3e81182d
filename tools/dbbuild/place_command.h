// 'dbbuild place': puts a model of a database somewhere; also for whoever has the options from elsewhere than
// a command line.
#pragma once

#include <string>
#include <vector>

#include "libdb/build/place_models.h"
#include "tools/common/command_line.h"

namespace deltaz {

// As people write them; empty texts are options not given.
struct PlaceOptionTexts {
  std::vector<std::string> at;  // LAT,LON[,ALT]
  std::string heading, from;

  void addTo(CLI::App& app);
  // All places, those of the file included, which is read here. kUsage naming the option, kInvalid naming
  // the line.
  Result<std::vector<PlacementRequest>> parse() const;
};

// Places `model` of the database `area` and reports as `common` says.
Result<int> runPlace(const std::string& area, const std::string& model, const PlaceOptionTexts& texts,
                     const CommonOptions& common);

}  // namespace deltaz
