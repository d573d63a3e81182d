#include "tools/dbview/sweep_command.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <system_error>
#include <thread>
#include <unistd.h>

#include "librender/antialias/sample_grid.h"
#include "librender/sweep/requantized_area.h"
#include "tools/common/output_file.h"
#include "tools/common/progress.h"
#include "tools/dbview/sweep_json.h"
#include "tools/dbview/sweep_svg.h"

namespace deltaz {

namespace {

// A folder of our own for what is thrown away at the end.
class ScratchFolder {
 public:
  static Result<ScratchFolder> make() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "deltaz-sweep-XXXXXX").string();
    if (error || mkdtemp(name.data()) == nullptr)
      return accessError(name, "cannot make a temporary folder", {},
                         "Set TMPDIR to a folder that can be written");
    return ScratchFolder(std::move(name));
  }
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return joinPath(path_, name); }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

double loadNow() {
  std::array<double, 1> load{};
  return getloadavg(load.data(), 1) == 1 ? load[0] : -1;
}

std::string metresText(const Rational& quantum) {
  return fmt::format("{}", quantum.value());
}

// The database's own quantum: one for all its grids, or their list.
std::string ownQuantum(const AreaHeader& area) {
  std::string text;
  for (const GridHeader& grid : area.grids) {
    const std::string one = metresText(grid.quantum);
    if (text.empty()) {
      text = one;
    } else if (text.find(one) == std::string::npos) {
      text += "/" + one;
    }
  }
  return text;
}

Result<std::vector<SweepView>> viewsOf(const Database& database, const SweepPlan& plan) {
  if (plan.views_of_area) return defaultViews(database, plan.camera.camera);
  if (!plan.views.empty()) return placeViews(database, plan.views);
  DELTAZ_TRY_ASSIGN(const Camera camera, placeCamera(database, plan.camera));
  return std::vector<SweepView>{{"view", camera}};
}

// Every combination, database by database.
std::vector<SweepSetting> settingsOf(const SweepPlan& plan, std::size_t databases) {
  std::vector<SweepSetting> settings;
  for (std::size_t database = 0; database < databases; ++database) {
    for (const TransformKind transform : plan.transforms) {
      for (const LodScheme lod : plan.lods) {
        // Ranges know no tolerance; models are drawn at the default one.
        const std::vector<double> by_range = {1};
        for (const double tolerance : lod == LodScheme::kReport ? by_range : plan.tolerances) {
          for (const int samples : plan.samples)
            settings.push_back({database, tolerance, lod, transform, samples});
        }
      }
    }
  }
  return settings;
}

// Of the picture that others are held against: where samples are tried, as many as every view has room for.
// kUsage if a view has no room for what is tried.
Result<int> referenceSamples(const SweepPlan& plan, const std::vector<SweepView>& views) {
  const auto check = [&](int samples) -> Status {
    RenderOptions options = plan.render;
    options.sampling.count = samples;
    for (const SweepView& view : views) {
      options.camera = view.camera;
      DELTAZ_TRY(checkSampling(options));
    }
    return Success{};
  };
  const int most = plan.samples.back();
  DELTAZ_TRY(check(most));
  if (most == 1) return 1;
  for (const int samples : {64, 16}) {
    if (samples > most && check(samples).ok()) return samples;
  }
  return most;
}

}  // namespace

Result<int> runSweep(const SweepOptions& options) {
  DELTAZ_TRY_ASSIGN(const SweepPlan plan, parseSweep(options));
  std::optional<ScratchFolder> scratch;
  std::deque<Database> databases;
  DELTAZ_TRY_ASSIGN(Database own, Database::open(localFileSystem(), options.area));
  databases.push_back(std::move(own));
  const Database& database = databases.front();
  DELTAZ_TRY(checkScene(database, options.scene, plan.render));

  SweepReport report;
  report.area = baseName(options.area);
  report.repeats = plan.repeats;
  report.reference_tolerance = plan.reference_tolerance;
  report.quanta.push_back(ownQuantum(database.area()));
  report.machine.processors = static_cast<int>(std::thread::hardware_concurrency());
  report.machine.threads = plan.render.threads > 0 ? std::min(plan.render.threads, report.machine.processors)
                                                   : report.machine.processors;
  {
    ProgressReporter progress(progressMode(options.common), "dbview", std::cerr);
    SweepRequest request;
    DELTAZ_TRY_ASSIGN(request.views, viewsOf(database, plan));
    for (const Rational& quantum : plan.quanta) {
      if (metresText(quantum) == report.quanta.front()) continue;
      progress.report(fmt::format("building with quantum {}", metresText(quantum)), 0);
      if (!scratch) {
        DELTAZ_TRY_ASSIGN(ScratchFolder folder, ScratchFolder::make());
        scratch.emplace(std::move(folder));
      }
      const std::string copy = scratch->file(fmt::format("{}.dz", databases.size()));
      DELTAZ_TRY(buildRequantized(localFileSystem(), database, quantum, copy, plan.render.threads));
      DELTAZ_TRY_ASSIGN(Database opened, Database::open(localFileSystem(), copy));
      databases.push_back(std::move(opened));
      report.quanta.push_back(metresText(quantum));
    }
    request.settings = settingsOf(plan, databases.size());
    request.common = plan.render;
    request.reference_tolerance = plan.reference_tolerance;
    DELTAZ_TRY_ASSIGN(request.reference_samples, referenceSamples(plan, request.views));
    report.reference_samples = request.reference_samples;
    report.sampling = plan.render.sampling;
    request.repeats = plan.repeats;
    request.progress = [&](double fraction) { progress.report("sweeping", fraction); };
    std::vector<const Database*> swept;
    for (const Database& each : databases) swept.push_back(&each);
    report.machine.load_before = loadNow();
    DELTAZ_TRY_ASSIGN(report.views, sweep(swept, request));
    report.machine.load_after = loadNow();
    report.all = overAllViews(report.views);
    progress.report("done", 1);
  }

  const std::string json = jsonText(sweepJson(report));
  const bool overwrite = options.common.overwrite;
  if (!plan.svg_path.empty()) DELTAZ_TRY(writeOutput(plan.svg_path, sweepSvg(report), overwrite));
  if (!plan.json_path.empty()) DELTAZ_TRY(writeOutput(plan.json_path, json, overwrite));
  if (options.common.json) {
    std::cout << json;
  } else if (!options.common.quiet) {
    std::cout << textReport(report);
  }
  return kExitDone;
}

}  // namespace deltaz
