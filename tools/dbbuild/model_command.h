// 'dbbuild model': mesh files become a model of a database; also for whoever has the options from elsewhere
// than a command line.
#pragma once

#include <string>
#include <vector>

#include "libdb/build/build_model.h"
#include "tools/common/command_line.h"

namespace deltaz {

// As people write them; empty texts mean the standard value.
struct ModelOptionTexts {
  std::string name, units = "m", up, lods, anchor = "base";

  void addTo(CLI::App& app);
  // kUsage, naming the option. Of the options, `provenance` holds those that differ from the standard.
  Result<ModelBuildOptions> parse() const;
};

// Reads `meshes` into the database `area` and reports as `common` says.
Result<int> runModel(const std::string& area, const std::vector<std::string>& meshes,
                     const ModelOptionTexts& texts, const CommonOptions& common);

// Takes the model `name` out of the database `area`.
Result<int> runModelRemoval(const std::string& area, const std::string& name, const CommonOptions& common);

}  // namespace deltaz
