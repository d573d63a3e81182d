// dbbuild export: a level of a database as GeoTIFF.
#include <fmt/format.h>
#include <iostream>
#include <limits>

#include "libdb/export/export_terrain.h"
#include "tools/common/json_output.h"
#include "tools/common/parse.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

class ExportCommand final : public Command {
 public:
  explicit ExportCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("export", "Write a level of a database as GeoTIFF")) {
    addPathOption(app_, "AREA.dz", area_, "The database")->required();
    addPathOption(app_, "-o,--output", target_, "The GeoTIFF to write")->required()->type_name("DEM.tif");
    app_.add_option("--level", level_, "Level of detail, 0 is the finest (default: 0)")->type_name("K");
    app_.add_option("--grid", grid_, "Number of the grid (default: 0)")->type_name("N");
    addCommonOptions(app_, common_, true);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    ExportOptions options;
    options.overwrite = common_.overwrite;
    DELTAZ_TRY(common_.threads());
    DELTAZ_TRY_ASSIGN(const std::int64_t level, parseInteger(level_, "--level", 0, kHighestNumber));
    DELTAZ_TRY_ASSIGN(const std::int64_t grid, parseInteger(grid_, "--grid", 0, kHighestNumber));
    options.level = static_cast<int>(level);
    options.grid = static_cast<int>(grid);
    DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), area_));
    DELTAZ_TRY(exportTerrain(database, target_, options));
    if (common_.json) {
      Json json = jsonHeader("dbbuild");
      json["area"] = area_;
      json["output"] = target_;
      json["grid"] = options.grid;
      json["level"] = options.level;
      std::cout << jsonText(json);
    } else if (!common_.quiet) {
      std::cout << fmt::format("{}: grid {}, level {} of {}\n", target_, options.grid, options.level, area_);
    }
    return kExitDone;
  }

 private:
  static constexpr std::int64_t kHighestNumber = std::numeric_limits<std::uint16_t>::max();

  CLI::App& app_;
  CommonOptions common_;
  std::string area_, target_;
  std::string level_ = "0", grid_ = "0";
};

}  // namespace

std::unique_ptr<Command> makeExportCommand(CLI::App& parent) {
  return std::make_unique<ExportCommand>(parent);
}

}  // namespace deltaz
