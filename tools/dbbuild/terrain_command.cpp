// dbbuild terrain: a DEM in, a database out.
#include <bit>
#include <fmt/format.h>
#include <iostream>
#include <vector>

#include "formats/terrain_segment.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "tools/common/json_output.h"
#include "tools/common/parse.h"
#include "tools/common/progress.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

constexpr int kSmallestLeaf = 8;

class TerrainCommand final : public Command {
 public:
  explicit TerrainCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("terrain", "Build a database from a DEM")) {
    app_.add_option("DEM", sources_, "The DEM: GeoTIFF, DTED, SRTM .hgt (also zipped), ...")->required();
    addPathOption(app_, "-o,--output", target_, "The database to make, AREA.dz")
        ->required()
        ->type_name("AREA.dz");
    app_.add_option("--leaf", leaf_, "Cells along a leaf's side, a power of two (default: 64)")
        ->type_name("CELLS");
    app_.add_option("--crs", crs_, "CRS of a source that names none, e.g. EPSG:4326")->type_name("CRS");
    addCommonOptions(app_, common_, true);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    if (sources_.size() != 1) {
      return usageError("DEM",
                        fmt::format("this version builds from one DEM, and {} were given", sources_.size()),
                        {}, "Join them first, for instance with gdalbuildvrt");
    }
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
    DELTAZ_TRY_ASSIGN(const RawGrid grid, readElevationSource(sources_.front(), SourceOptions{crs_}));
    DELTAZ_TRY_ASSIGN(const BuildSummary summary, buildTerrain(localFileSystem(), grid, target_, options));
    progress.report("done", 1);
    print(summary);
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

  void print(const BuildSummary& summary) const {
    if (common_.json) {
      Json json = jsonHeader("dbbuild");
      json["area"] = target_;
      json["posts"] = summary.posts;
      json["voids"] = summary.voids;
      json["levels"] = summary.levels;
      json["nodes"] = summary.nodes;
      json["bytes"] = summary.bytes;
      json["largest_error"] = finiteOrNull(summary.largest_error);
      std::cout << jsonText(json);
    } else if (!common_.quiet) {
      std::cout << fmt::format(
          "{}: {} posts ({} void), {} levels, {} nodes, {} bytes; coarsest level within {:.1f} m\n", target_,
          summary.posts, summary.voids, summary.levels, summary.nodes, summary.bytes, summary.largest_error);
    }
  }

  CLI::App& app_;
  CommonOptions common_;
  std::vector<std::string> sources_;
  std::string target_;
  std::string leaf_ = "64";
  std::string crs_;
};

}  // namespace

std::unique_ptr<Command> makeTerrainCommand(CLI::App& parent) {
  return std::make_unique<TerrainCommand>(parent);
}

}  // namespace deltaz
