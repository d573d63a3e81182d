// dbbuild color: adds a colour map to a database, or takes one out.
#include <fmt/format.h>
#include <iostream>

#include "libdb/build/color_map_edit.h"
#include "tools/common/json_output.h"
#include "tools/common/progress.h"
#include "tools/dbbuild/color_options.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

Result<int> runRemoval(const std::string& area, const ColorOptionTexts& texts, const CommonOptions& common) {
  if (!texts.image.empty() || !texts.ramp.empty() || !texts.classes.empty() || !texts.legend.empty() ||
      !texts.synthetic.empty())
    return usageError("--remove", "it takes a colour map out and cannot make one", {},
                      "Give nothing but the name beside it");
  DELTAZ_TRY(removeColorMap(localFileSystem(), area, texts.name));
  if (common.json) {
    Json json = jsonHeader("dbbuild");
    json["area"] = area;
    json["name"] = texts.name;
    json["removed"] = true;
    std::cout << jsonText(json);
  } else if (!common.quiet) {
    std::cout << fmt::format("{}: colour map {} removed; 'dbbuild gc' frees its file\n", area, texts.name);
  }
  return kExitDone;
}

void print(const std::string& area, const std::string& name, const ColorBuildSummary& summary,
           const CommonOptions& common) {
  if (common.json) {
    Json json = jsonHeader("dbbuild");
    json["area"] = area;
    json["name"] = name;
    json["nodes"] = summary.nodes;
    json["finest_level"] = summary.finest_level;
    json["coarsest_level"] = summary.coarsest_level;
    json["bytes"] = summary.bytes;
    json["warnings"] = summary.warnings;
    std::cout << jsonText(json);
  } else if (!common.quiet) {
    std::cout << fmt::format("{}: colour map {}, levels {} to {}, {} nodes, {} bytes\n", area, name,
                             summary.finest_level, summary.coarsest_level, summary.nodes, summary.bytes);
  }
}

class ColorCommand final : public Command {
 public:
  explicit ColorCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("color", "Add a colour map to a database, or take one out")) {
    addPathOption(app_, "AREA.dz", area_, "The database")->required();
    texts_.addTo(app_);
    addCommonOptions(app_, common_, true);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override { return runColor(area_, texts_, common_); }

 private:
  CLI::App& app_;
  CommonOptions common_;
  std::string area_;
  ColorOptionTexts texts_;
};

}  // namespace

Result<int> runColor(const std::string& area, const ColorOptionTexts& texts, const CommonOptions& common) {
  DELTAZ_TRY_ASSIGN(const int threads, common.threads());
  if (texts.remove) return runRemoval(area, texts, common);
  DELTAZ_TRY_ASSIGN(ColorBuildOptions options, texts.parse());
  options.threads = threads;
  options.overwrite = common.overwrite;
  ProgressReporter progress(progressMode(common), "dbbuild", std::cerr);
  options.progress = [&progress](std::string_view phase, double fraction) {
    progress.report(phase, fraction);
  };
  DELTAZ_TRY_ASSIGN(const ColorBuildSummary summary, buildColor(localFileSystem(), area, options));
  progress.report("done", 1);
  for (const std::string& warning : summary.warnings) {
    if (!common.quiet) std::cerr << "dbbuild: warning: " + warning + "\n";
  }
  print(area, texts.name, summary, common);
  return kExitDone;
}

std::unique_ptr<Command> makeColorCommand(CLI::App& parent) {
  return std::make_unique<ColorCommand>(parent);
}

}  // namespace deltaz
