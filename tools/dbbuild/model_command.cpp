#include "tools/dbbuild/model_command.h"

#include <array>
#include <fmt/format.h>
#include <iostream>

#include "formats/file_system.h"
#include "libdb/build/model_writer.h"
#include "tools/common/json_output.h"
#include "tools/common/parse.h"
#include "tools/common/progress.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array<Unit, 9> kUnits = {{{"m", 1},
                                         {"cm", 0.01},
                                         {"mm", 0.001},
                                         {"km", 1000},
                                         {"in", 0.0254},
                                         {"ft", 0.3048},
                                         {"us-ft", 1200.0 / 3937.0},
                                         {"yd", 0.9144},
                                         {"mi", 1609.344}}};

Result<double> metresOf(const std::string& unit) {
  std::string names;
  for (const Unit& known : kUnits) {
    if (unit == known.name) return known.metres;
    names += (names.empty() ? "" : ", ") + std::string(known.name);
  }
  return usageError("--units", fmt::format("'{}' is not a unit of length known here", unit), {},
                    "Known are " + names);
}

void printJson(const std::string& area, const std::string& name, const ModelSummary& summary) {
  Json json = jsonHeader("dbbuild");
  json["area"] = area;
  json["model"] = name;
  json["size_metres"] = summary.size;
  json["parts"] = Json::array();
  for (const ModelSummary::Part& part : summary.parts) {
    Json line;
    line["name"] = part.name;
    line["parent"] = part.parent.empty() ? Json(nullptr) : Json(part.parent);
    line["lods"] = Json::array();
    for (const ModelSummary::Lod& lod : part.lods)
      line["lods"].push_back({{"triangles", lod.triangles}, {"error_metres", lod.error}});
    json["parts"].push_back(std::move(line));
  }
  const RepairReport& repairs = summary.repairs;
  json["repairs"] = {{"welded_vertices", repairs.welded_vertices},
                     {"isolated_vertices", repairs.isolated_vertices},
                     {"degenerate_triangles", repairs.degenerate_triangles},
                     {"duplicate_triangles", repairs.duplicate_triangles},
                     {"turned_triangles", repairs.turned_triangles},
                     {"non_manifold_edges", repairs.non_manifold_edges},
                     {"inside_out_shells", repairs.inside_out_shells},
                     {"open_edges", repairs.open_edges}};
  json["warnings"] = summary.warnings;
  std::cout << jsonText(json);
}

// Millimetres; of what is so small that they would hide it, three digits.
std::string lengthText(double metres) {
  return metres > 0 && metres < 0.1 ? fmt::format("{:.3g}", metres) : fmt::format("{:.3f}", metres);
}

void printText(const std::string& area, const std::string& name, const ModelSummary& summary, bool verbose) {
  std::size_t triangles = 0, meshes = 0;
  for (const ModelSummary::Part& part : summary.parts) {
    if (part.lods.empty()) continue;
    triangles += part.lods.front().triangles;
    ++meshes;
  }
  std::cout << fmt::format("{}: model {}: {} triangle{} in {} of {} part{}; {} x {} x {} m\n", area, name,
                           triangles, triangles == 1 ? "" : "s", meshes, summary.parts.size(),
                           summary.parts.size() == 1 ? "" : "s", lengthText(summary.size[0]),
                           lengthText(summary.size[1]), lengthText(summary.size[2]));
  for (const std::string& line : summary.repairs.lines()) std::cout << "  " + line + "\n";
  for (const ModelSummary::Part& part : summary.parts) {
    if (!verbose) break;
    std::string levels;
    for (const ModelSummary::Lod& lod : part.lods)
      levels += fmt::format("{} {} (error {:.4g} m)", levels.empty() ? ":" : ",", lod.triangles, lod.error);
    std::cout << "  " + part.name + levels + "\n";
  }
}

class ModelCommand final : public Command {
 public:
  explicit ModelCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("model", "Bring meshes into a database as a model")) {
    addPathOption(app_, "AREA", area_, "The database, AREA.dz")->required()->type_name("AREA.dz");
    app_.add_option("MESH", meshes_, "The mesh files, parts of one model: OBJ, PLY, STL, OFF, glTF or GLB");
    app_.add_flag("--remove", remove_, "Take the model out of the database again");
    texts_.addTo(app_);
    addCommonOptions(app_, common_, true);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    if (!remove_) return runModel(area_, meshes_, texts_, common_);
    if (!meshes_.empty()) return usageError("--remove", "it takes a name and no mesh");
    return runModelRemoval(area_, texts_.name, common_);
  }

 private:
  CLI::App& app_;
  CommonOptions common_;
  std::string area_;
  std::vector<std::string> meshes_;
  bool remove_ = false;
  ModelOptionTexts texts_;
};

}  // namespace

void ModelOptionTexts::addTo(CLI::App& app) {
  app.add_option("--name", name, "Name of the model")->required()->type_name("NAME");
  app.add_option("--units", units,
                 "Unit of the files' coordinates: m, cm, mm, km, in, ft, us-ft, yd or mi (default: m)")
      ->type_name("UNIT");
  app.add_option("--up", up, "Axis that points up in the files (default: y for glTF, else z)")
      ->type_name("y|z");
  app.add_option("--lods", lods, "Levels of detail at most; 1: the finest alone (default: as many as pay)")
      ->type_name("N");
  app.add_option("--anchor", anchor,
                 "Point that stands where the model is placed: the middle of its base, or the origin of the "
                 "files (default: base)")
      ->type_name("base|origin");
}

Result<ModelBuildOptions> ModelOptionTexts::parse() const {
  ModelBuildOptions options;
  options.name = name;
  if (!isAssetName(name)) {
    return usageError("--name", fmt::format("'{}' cannot name a model", name),
                      "names are 1 to 64 of A-Z a-z 0-9 _ - and dots within");
  }
  if (anchor == "origin") {
    options.anchor = ModelAnchor::kOrigin;
    options.provenance.emplace_back("anchor", anchor);
  } else if (anchor != "base" && !anchor.empty()) {
    return usageError("--anchor", fmt::format("'{}' is neither base nor origin", anchor));
  }
  if (!lods.empty()) {
    DELTAZ_TRY_ASSIGN(const std::int64_t count, parseInteger(lods, "--lods", 1, kMaximumPartLods));
    options.lods = static_cast<std::size_t>(count);
    options.provenance.emplace_back("lods", lods);
  }
  DELTAZ_TRY_ASSIGN(options.source.unit_metres, metresOf(units.empty() ? "m" : units));
  if (!units.empty() && units != "m") options.provenance.emplace_back("units", units);
  if (up == "y" || up == "z") {
    options.source.up = up == "y" ? UpAxis::kY : UpAxis::kZ;
    options.provenance.emplace_back("up", up);
  } else if (!up.empty()) {
    return usageError("--up", fmt::format("'{}' is neither y nor z", up));
  }
  return options;
}

Result<int> runModel(const std::string& area, const std::vector<std::string>& meshes,
                     const ModelOptionTexts& texts, const CommonOptions& common) {
  if (meshes.empty()) return usageError("MESH", "no mesh is given", {}, "Name one or more files");
  DELTAZ_TRY_ASSIGN(ModelBuildOptions options, texts.parse());
  options.overwrite = common.overwrite;
  DELTAZ_TRY_ASSIGN(options.threads, common.threads());
  ProgressReporter progress(progressMode(common), "dbbuild", std::cerr);
  options.progress = [&progress](std::string_view phase, double fraction) {
    progress.report(phase, fraction);
  };
  DELTAZ_TRY_ASSIGN(const ModelSummary summary, buildModel(localFileSystem(), area, meshes, options));
  for (const std::string& warning : summary.warnings) {
    if (!common.quiet) std::cerr << "dbbuild: warning: " + warning + "\n";
  }
  if (common.json) {
    printJson(area, texts.name, summary);
  } else if (!common.quiet) {
    printText(area, texts.name, summary, common.verbose);
  }
  return kExitDone;
}

Result<int> runModelRemoval(const std::string& area, const std::string& name, const CommonOptions& common) {
  DELTAZ_TRY(removeModel(localFileSystem(), area, name));
  if (common.json) {
    Json json = jsonHeader("dbbuild");
    json["area"] = area;
    json["removed_model"] = name;
    std::cout << jsonText(json);
  } else if (!common.quiet) {
    std::cout << fmt::format("{}: model {} removed\n", area, name);
  }
  return kExitDone;
}

std::unique_ptr<Command> makeModelCommand(CLI::App& parent) {
  return std::make_unique<ModelCommand>(parent);
}

}  // namespace deltaz
