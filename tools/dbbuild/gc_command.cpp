// dbbuild gc: removes the files that a database no longer lists.
#include <fmt/format.h>
#include <iostream>

#include "libdb/build/publication.h"
#include "tools/common/json_output.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

class GcCommand final : public Command {
 public:
  explicit GcCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("gc", "Remove the files of older states of a database")) {
    addPathOption(app_, "AREA.dz", area_, "The database")->required();
    addCommonOptions(app_, common_, false);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    DELTAZ_TRY(common_.threads());
    DELTAZ_TRY_ASSIGN(const std::vector<std::string> removed, removeUnlisted(localFileSystem(), area_));
    if (common_.json) {
      Json json = jsonHeader("dbbuild");
      json["area"] = area_;
      json["removed"] = removed;
      std::cout << jsonText(json);
    } else if (!common_.quiet) {
      for (const std::string& name : removed) std::cout << name + "\n";
    }
    return kExitDone;
  }

 private:
  CLI::App& app_;
  CommonOptions common_;
  std::string area_;
};

}  // namespace

std::unique_ptr<Command> makeGcCommand(CLI::App& parent) {
  return std::make_unique<GcCommand>(parent);
}

}  // namespace deltaz
