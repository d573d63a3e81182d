// dbbuild info: what is in a database.
#include <cmath>
#include <fmt/format.h>
#include <iostream>

#include "libdb/access/content_digest.h"
#include "libdb/access/database.h"
#include "libdb/source/reference_system.h"
#include "tools/common/json_output.h"
#include "tools/dbbuild/asset_report.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

std::string rationalText(const Rational& value) {
  return value.denominator == 1 ? std::to_string(value.numerator)
                                : fmt::format("{}/{}", value.numerator, value.denominator);
}

Json axisJson(const GridAxis& axis, bool geodetic) {
  Json json;
  json["spacing"] = axis.spacing;
  const Json exact = axis.exact_spacing ? Json(rationalText(*axis.exact_spacing)) : Json(nullptr);
  json[geodetic ? "spacing_arc_seconds" : "spacing_exact"] = exact;
  json["phase"] = axis.phase;
  json["first"] = axis.first;
  json["count"] = axis.count;
  return json;
}

// A stored value that means void; JSON has no NaN.
Json storedJson(double value) {
  return std::isnan(value) ? Json("nan") : Json(value);
}

Json sourceJson(const SourceDescription& source) {
  Json json;
  json["name"] = source.name;
  json["content"] = toHex(source.content);
  json["driver"] = source.driver;
  json["columns"] = source.columns;
  json["rows"] = source.rows;
  json["data_type"] = source.data_type;
  json["nodata"] = source.nodata ? storedJson(*source.nodata) : Json(nullptr);
  json["unit"] = source.unit;
  json["band"] = source.band;
  json["scale"] = source.scale;
  json["offset"] = source.offset;
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
  json["height_error"] = grid.height_error;
  const bool geodetic = grid.kind == "geodetic";
  json[geodetic ? "longitude" : "x"] = axisJson(grid.x_axis, geodetic);
  json[geodetic ? "latitude" : "y"] = axisJson(grid.y_axis, geodetic);
  json["patches"] = nullptr;
  if (grid.patches) {
    json["patches"] = {{"cells", grid.patches->cells},
                       {"columns", grid.patches->columns},
                       {"rows", grid.patches->rows},
                       {"error", grid.patches->error}};
  }
  json["resampling"] = nullptr;
  if (grid.resampling) {
    json["resampling"] = {{"method", grid.resampling->method},
                          {"largest_error", grid.resampling->largest_error},
                          {"rms_error", grid.resampling->rms_error}};
  }
  json["sentinels"] = Json::array();
  for (const double sentinel : grid.sentinels) json["sentinels"].push_back(storedJson(sentinel));
  json["leaf_cells"] = grid.leaf_cells;
  json["level_count"] = grid.level_count;
  json["normal_exponent"] = grid.normal_exponent;
  json["diagonal"] = grid.diagonal;
  json["sources"] = Json::array();
  for (const SourceDescription& source : grid.sources) json["sources"].push_back(sourceJson(source));
  return json;
}

Result<Json> areaJson(const std::string& path, const Database& database) {
  const AreaHeader& area = database.area();
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
  json["color_maps"] = colorMapsJson(database);
  json["models"] = modelsJson(database);
  DELTAZ_TRY_ASSIGN(json["placements"], placementsJson(database));
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

// Latitudes and longitudes of another datum than the area's are placed as those of a projection are.
bool isOfOtherDatum(const GridHeader& grid) {
  if (grid.kind == "geodetic") return false;
  const Result<ReferenceSystem> system = parseReferenceSystem(grid.crs_wkt, "area.json");
  return system.ok() && !system.value().projected;
}

std::string axisText(const GridAxis& axis, bool geodetic, bool degrees) {
  if (geodetic && axis.exact_spacing) return rationalText(*axis.exact_spacing) + " arc-seconds";
  return fmt::format("{} {}", axis.spacing, degrees ? "degrees" : "units");
}

// The lines only some grids need.
std::string specialsText(const GridHeader& grid) {
  std::string text;
  if (grid.height_error > 0)
    text += fmt::format("    rounding      heights within {} m of the source\n", grid.height_error);
  if (grid.patches) {
    text += fmt::format("    placed by     {} x {} patches of {} cells, within {:.1e} m of PROJ\n",
                        grid.patches->columns, grid.patches->rows, grid.patches->cells, grid.patches->error);
  }
  if (grid.resampling) {
    text += fmt::format("    resampled     {}; the sources' posts within {:.3f} m, {:.3f} m rms\n",
                        grid.resampling->method, grid.resampling->largest_error, grid.resampling->rms_error);
  }
  if (!grid.sentinels.empty()) {
    text += "    voids held    ";
    for (std::size_t k = 0; k < grid.sentinels.size(); ++k)
      text += fmt::format("{}{}", k == 0 ? "" : ", ", grid.sentinels[k]);
    text += "\n";
  }
  return text;
}

std::string areaText(const std::string& path, const Database& database, bool verbose) {
  const AreaHeader& area = database.area();
  std::string text =
      fmt::format("{}: built by {}, generation {}\n", path, area.tool_version, area.generation);
  text += fmt::format("  bounds W,S,E,N  {},{},{},{}\n", area.west, area.south, area.east, area.north);
  text += fmt::format("  heights         {} .. {} m\n", area.lowest_height, area.highest_height);
  text += fmt::format("  nodes           {}\n", area.node_count);
  for (std::size_t i = 0; i < area.grids.size(); ++i) {
    const GridHeader& grid = area.grids[i];
    const bool geodetic = grid.kind == "geodetic", other_datum = isOfOtherDatum(grid);
    text += fmt::format("  grid {}          {}, {} x {} posts, {} x {}\n", i,
                        other_datum ? "geographic, of another datum" : grid.kind, grid.x_axis.count,
                        grid.y_axis.count, axisText(grid.x_axis, geodetic, geodetic || other_datum),
                        axisText(grid.y_axis, geodetic, geodetic || other_datum));
    text += fmt::format("    datum         {}; heights: {}\n", grid.horizontal_datum, grid.vertical_datum);
    text += fmt::format("    quantum       {} m, leaves of {} cells, {} levels\n", rationalText(grid.quantum),
                        grid.leaf_cells, grid.level_count);
    text += specialsText(grid);
    for (const SourceDescription& source : grid.sources) {
      text += fmt::format("    source        {} ({}, {})\n", source.name, source.driver, source.data_type);
    }
  }
  text += assetsText(database, verbose);
  for (const auto& [name, value] : area.options)
    text += fmt::format("  option          {}: {}\n", name, value);
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
      DELTAZ_TRY_ASSIGN(Json json, areaJson(area_, database));
      if (digest_) json["content_digest"] = digest;
      std::cout << jsonText(json);
    } else if (digest_) {
      // Alone on its line, so that two databases can be compared by comparing the outputs.
      std::cout << digest + "\n";
    } else if (!common_.quiet) {
      std::cout << areaText(area_, database, common_.verbose);
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
