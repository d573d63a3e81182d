// dbbuild info: what is in a database.
#include <fmt/format.h>
#include <iostream>

#include "libdb/access/content_digest.h"
#include "libdb/access/database.h"
#include "tools/common/json_output.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

std::string rationalText(const Rational& value) {
  return value.denominator == 1 ? std::to_string(value.numerator)
                                : fmt::format("{}/{}", value.numerator, value.denominator);
}

Json axisJson(const GridAxis& axis) {
  Json json;
  json["spacing"] = axis.spacing;
  json["spacing_arc_seconds"] = axis.exact_spacing ? Json(rationalText(*axis.exact_spacing)) : Json(nullptr);
  json["phase"] = axis.phase;
  json["first"] = axis.first;
  json["count"] = axis.count;
  return json;
}

Json sourceJson(const SourceDescription& source) {
  Json json;
  json["name"] = source.name;
  json["content"] = toHex(source.content);
  json["driver"] = source.driver;
  json["columns"] = source.columns;
  json["rows"] = source.rows;
  json["data_type"] = source.data_type;
  json["nodata"] = source.nodata ? finiteOrNull(*source.nodata) : Json(nullptr);
  json["unit"] = source.unit;
  json["point_registered"] = source.point_registered;
  return json;
}

Json gridJson(const GridHeader& grid) {
  Json json;
  json["kind"] = grid.kind;
  json["horizontal_datum"] = grid.horizontal_datum;
  json["vertical_datum"] = grid.vertical_datum;
  json["coordinate_epoch"] = grid.coordinate_epoch ? finiteOrNull(*grid.coordinate_epoch) : Json(nullptr);
  json["semi_major_axis"] = grid.ellipsoid.semi_major_axis;
  json["inverse_flattening"] = grid.ellipsoid.inverse_flattening;
  json["crs_wkt"] = grid.crs_wkt;
  json["unit"] = grid.unit;
  json["quantum"] = rationalText(grid.quantum);
  json["longitude"] = axisJson(grid.x_axis);
  json["latitude"] = axisJson(grid.y_axis);
  json["leaf_cells"] = grid.leaf_cells;
  json["level_count"] = grid.level_count;
  json["normal_exponent"] = grid.normal_exponent;
  json["diagonal"] = grid.diagonal;
  json["sources"] = Json::array();
  for (const SourceDescription& source : grid.sources) json["sources"].push_back(sourceJson(source));
  return json;
}

Json areaJson(const std::string& path, const AreaHeader& area) {
  Json json = jsonHeader("dbbuild");
  json["area"] = path;
  json["built_by"] = area.tool_version;
  json["generation"] = area.generation;
  json["bounds"] = {{"west", area.west}, {"south", area.south}, {"east", area.east}, {"north", area.north}};
  json["lowest_height"] = area.lowest_height;
  json["highest_height"] = area.highest_height;
  json["sea_drop"] = finiteOrNull(area.sea_drop);
  json["nodes"] = area.node_count;
  json["grids"] = Json::array();
  for (const GridHeader& grid : area.grids) json["grids"].push_back(gridJson(grid));
  json["files"] = Json::array();
  for (const FileReference& file : area.files) {
    json["files"].push_back({{"name", file.name},
                             {"role", std::string(fileRoleName(file.role))},
                             {"bytes", file.length},
                             {"id", toHex(file.id)}});
  }
  json["options"] = Json::object();
  for (const auto& [name, value] : area.options) json["options"][name] = value;
  return json;
}

std::string axisText(const GridAxis& axis) {
  return axis.exact_spacing ? rationalText(*axis.exact_spacing) + " arc-seconds"
                            : fmt::format("{} degrees", axis.spacing);
}

std::string areaText(const std::string& path, const AreaHeader& area, bool verbose) {
  std::string text =
      fmt::format("{}: built by {}, generation {}\n", path, area.tool_version, area.generation);
  text += fmt::format("  bounds W,S,E,N  {},{},{},{}\n", area.west, area.south, area.east, area.north);
  text += fmt::format("  heights         {} .. {} m\n", area.lowest_height, area.highest_height);
  text += fmt::format("  nodes           {}\n", area.node_count);
  for (std::size_t i = 0; i < area.grids.size(); ++i) {
    const GridHeader& grid = area.grids[i];
    text += fmt::format("  grid {}          {}, {} x {} posts, {} x {}\n", i, grid.kind, grid.x_axis.count,
                        grid.y_axis.count, axisText(grid.x_axis), axisText(grid.y_axis));
    text += fmt::format("    datum         {}; heights: {}\n", grid.horizontal_datum, grid.vertical_datum);
    text += fmt::format("    quantum       {} m, leaves of {} cells, {} levels\n", rationalText(grid.quantum),
                        grid.leaf_cells, grid.level_count);
    for (const SourceDescription& source : grid.sources) {
      text += fmt::format("    source        {} ({}, {})\n", source.name, source.driver, source.data_type);
    }
  }
  for (const FileReference& file : area.files) {
    text += fmt::format("  file            {} ({} bytes)\n", file.name, file.length);
    if (verbose) text += fmt::format("    id            {}\n", toHex(file.id));
  }
  return text;
}

class InfoCommand final : public Command {
 public:
  explicit InfoCommand(CLI::App& parent) : app_(*parent.add_subcommand("info", "Say what is in a database")) {
    addPathOption(app_, "AREA.dz", area_, "The database")->required();
    app_.add_flag("--digest", digest_, "Print the content digest: equal for databases that say the same");
    addCommonOptions(app_, common_, false);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    DELTAZ_TRY(common_.threads());
    DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), area_));
    std::string digest;
    if (digest_) {
      DELTAZ_TRY_ASSIGN(const Hash128 hash, contentDigest(database));
      digest = toHex(hash);
    }
    if (common_.json) {
      Json json = areaJson(area_, database.area());
      if (digest_) json["content_digest"] = digest;
      std::cout << jsonText(json);
    } else if (digest_) {
      // Alone on its line, so that two databases can be compared by comparing the outputs.
      std::cout << digest + "\n";
    } else if (!common_.quiet) {
      std::cout << areaText(area_, database.area(), common_.verbose);
    }
    return kExitDone;
  }

 private:
  CLI::App& app_;
  CommonOptions common_;
  std::string area_;
  bool digest_ = false;
};

}  // namespace

std::unique_ptr<Command> makeInfoCommand(CLI::App& parent) {
  return std::make_unique<InfoCommand>(parent);
}

}  // namespace deltaz
