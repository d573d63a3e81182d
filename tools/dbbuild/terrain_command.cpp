// dbbuild terrain: DEMs in, a database out.
#include <bit>
#include <fmt/format.h>
#include <iostream>
#include <vector>

#include "formats/terrain_segment.h"
#include "libdb/build/build_terrain.h"
#include "tools/common/json_output.h"
#include "tools/common/parse.h"
#include "tools/common/progress.h"
#include "tools/dbbuild/command.h"
#include "tools/dbbuild/source_options.h"

namespace deltaz {

namespace {

constexpr int kSmallestLeaf = 8;

class TerrainCommand final : public Command {
 public:
  explicit TerrainCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("terrain", "Build a database from DEMs")) {
    app_.add_option(
            "DEM", sources_,
            "The DEMs: GeoTIFF, DTED, SRTM .hgt, USGS DEM, ASCII grid, VRT, zipped ...; those on one lattice "
            "are joined")
        ->required();
    addPathOption(app_, "-o,--output", target_, "The database to make, AREA.dz")
        ->required()
        ->type_name("AREA.dz");
    app_.add_option("--leaf", leaf_, "Cells along a leaf's side, a power of two (default: 64)")
        ->type_name("CELLS");
    texts_.addTo(app_);
    addCommonOptions(app_, common_, true);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    DELTAZ_TRY_ASSIGN(const SourceOptions source_options, texts_.parse());
    BuildOptions options;
    options.overwrite = common_.overwrite;
    DELTAZ_TRY_ASSIGN(options.threads, common_.threads());
    DELTAZ_TRY_ASSIGN(options.leaf_cells, leafCells());

    ProgressReporter progress(progressMode(common_), "dbbuild", std::cerr);
    progress.report("reading", 0);
    // Reading the source is counted as the first tenth of the work.
    options.progress = [&progress](std::string_view phase, double fraction) {
      progress.report(phase, 0.1 + 0.9 * fraction);
    };
    DELTAZ_TRY_ASSIGN(const SourceArea area, readElevationSources(sources_, source_options));
    for (const std::string& warning : area.warnings) {
      if (!common_.quiet) std::cerr << "dbbuild: warning: " + warning + "\n";
    }
    options.provenance = texts_.provenance();
    if (area.filled_posts > 0)
      options.provenance.emplace_back("void_filled_posts", std::to_string(area.filled_posts));
    DELTAZ_TRY_ASSIGN(const BuildSummary summary,
                      buildTerrain(localFileSystem(), area.grids, target_, options));
    progress.report("done", 1);
    print(area, summary);
    return kExitDone;
  }

 private:
  Result<int> leafCells() const {
    DELTAZ_TRY_ASSIGN(const std::int64_t cells,
                      parseInteger(leaf_, "--leaf", kSmallestLeaf, kMaximumLeafCells));
    if (!std::has_single_bit(static_cast<std::uint64_t>(cells)))
      return usageError("--leaf", leaf_ + " is not a power of two");
    return static_cast<int>(cells);
  }

  void print(const SourceArea& area, const BuildSummary& summary) const {
    if (common_.json) {
      Json json = jsonHeader("dbbuild");
      json["area"] = target_;
      json["grids"] = area.grids.size();
      json["posts"] = summary.posts;
      json["voids"] = summary.voids;
      json["filled"] = area.filled_posts;
      json["levels"] = summary.levels;
      json["nodes"] = summary.nodes;
      json["bytes"] = summary.bytes;
      json["largest_error"] = finiteOrNull(summary.largest_error);
      json["warnings"] = area.warnings;
      std::cout << jsonText(json);
    } else if (!common_.quiet) {
      std::cout << fmt::format(
          "{}: {}{} posts ({} void{}), {} levels, {} nodes, {} bytes; coarsest level within {:.1f} m\n",
          target_, area.grids.size() == 1 ? "" : fmt::format("{} grids, ", area.grids.size()), summary.posts,
          summary.voids, area.filled_posts == 0 ? "" : fmt::format(", {} filled", area.filled_posts),
          summary.levels, summary.nodes, summary.bytes, summary.largest_error);
    }
  }

  CLI::App& app_;
  CommonOptions common_;
  std::vector<std::string> sources_;
  std::string target_;
  std::string leaf_ = "64";
  SourceOptionTexts texts_;
};

}  // namespace

std::unique_ptr<Command> makeTerrainCommand(CLI::App& parent) {
  return std::make_unique<TerrainCommand>(parent);
}

}  // namespace deltaz
