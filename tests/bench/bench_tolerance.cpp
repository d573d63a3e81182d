// Run time versus error: what a tolerance in pixels saves, and what it really costs on the screen.
//   bench_tolerance [--smoke] [AREA.dz] [REPEATS]
// Renders three views of a database (samples/mt_rainier.tif, built on the spot, unless one is named) at
// tolerances 0 .. 8 pixels and prints, for each: level drawn, triangles drawn, median milliseconds a frame,
// the time as a share of full resolution, the scheduler's bound of the error, and the largest displacement
// measured at every full-resolution post in view. --smoke renders once, small, at two tolerances.
//
// The measured column must never exceed the bound, nor the bound the tolerance; a line where it does is
// marked, and the program ends with 1.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "librender/scene/render.h"
#include "tests/librender/cut_checks.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

const std::vector<double> kTolerances = {0, 0.25, 0.5, 1, 2, 4, 8};
const std::vector<double> kSmokeTolerances = {0, 4};

struct NamedView {
  std::string name;
  Camera camera;
};

struct Settings {
  bool smoke = false;
  std::string area;
  int repeats = 9;
};

// The whole area, an eye over its southern part looking north, and one high above its middle looking down
// steeply.
Result<std::vector<NamedView>> viewsOf(const Database& database, int width, int height) {
  const AreaHeader& area = database.area();
  const double latitude = (area.south + area.north) / 2, longitude = (area.west + area.east) / 2;
  std::vector<NamedView> views = {{"whole area", wholeAreaCamera(area, width, height, 60)}};
  Camera camera = views.front().camera;
  camera.heading = 0;
  camera.roll = 0;
  camera.pitch = -5;
  camera.eye = {area.south + 0.2 * (area.north - area.south), longitude, 0};
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                    groundHeight(database, camera.eye.latitude, longitude));
  camera.eye.height = ground.value_or(area.highest_height) + 500;
  views.push_back({"500 m above ground", camera});
  camera.pitch = -60;
  camera.eye = {latitude, longitude, area.highest_height + 10000};
  views.push_back({"10 km above the highest post", camera});
  return views;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Row {
  FrameStatistics statistics;
  double milliseconds = 0;
};

Result<Row> measure(const Engine& engine, const Database& database, const RenderOptions& options,
                    int repeats) {
  Row row;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    DELTAZ_TRY_ASSIGN(const Picture picture, engine.render(database, options, row.statistics));
    times.push_back(row.statistics.milliseconds.total);
  }
  row.milliseconds = median(times);
  return row;
}

// The table of one view; false if a line breaks a promise.
Result<bool> printTable(const Engine& engine, const Database& database, const NamedView& view,
                        const Settings& settings) {
  const int repeats = settings.smoke ? 1 : settings.repeats;
  fmt::print("\n{}, {} x {}\n", view.name, view.camera.width, view.camera.height);
  fmt::print("{:>12} {:>6} {:>12} {:>10} {:>8} {:>10} {:>12}\n", "tolerance px", "levels", "triangles",
             "ms/frame", "share", "bound px", "measured px");
  bool kept = true;
  double full_resolution = 0;
  const FullResolution full(database, 0);
  const ViewTransform transform = makeViewTransform(view.camera, database.area().grids.front().ellipsoid);
  for (const double tolerance : settings.smoke ? kSmokeTolerances : kTolerances) {
    RenderOptions options;
    options.camera = view.camera;
    options.tolerance = tolerance;
    DELTAZ_TRY_ASSIGN(const Row row, measure(engine, database, options, repeats));
    // What was drawn, borders between levels included, post by post.
    FrameStatistics::Nodes counts;
    DELTAZ_TRY_ASSIGN(const Schedule schedule,
                      scheduleNodes(database, SeamIndex(database), transform, {tolerance}, counts));
    const ContractFinding error = measureContract(
        database, meshOfCut(database, schedule, transform, MeshPart::kInView), full, transform);
    if (tolerance == 0) full_resolution = row.milliseconds;
    const double bound = row.statistics.projected_error;
    const bool line_kept = error.worst_pixels <= bound + 1e-6 && bound <= tolerance + 1e-6;
    kept = kept && line_kept;
    fmt::print("{:>12} {:>6} {:>12} {:>10.2f} {:>7.0f}% {:>10.3f} {:>12.3f}{}\n", tolerance,
               fmt::format("{}-{}", row.statistics.level, row.statistics.coarsest_level),
               row.statistics.triangles.drawn, row.milliseconds, 100 * row.milliseconds / full_resolution,
               bound, error.worst_pixels, line_kept ? "" : "  BROKEN");
  }
  return kept;
}

Result<bool> run(Settings settings) {
  const TemporaryDirectory folder;
  if (settings.area.empty()) {
    settings.area = folder.file("mt_rainier.dz");
    DELTAZ_TRY_ASSIGN(const RawGrid grid, readElevationSource(DELTAZ_SAMPLES "/mt_rainier.tif", {}));
    DELTAZ_TRY_ASSIGN(const BuildSummary summary, buildTerrain(localFileSystem(), grid, settings.area, {}));
    fmt::print("mt_rainier.tif: {} posts, {} levels\n", summary.posts, summary.levels);
  }
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), settings.area));
  const int width = settings.smoke ? 160 : 1280, height = settings.smoke ? 90 : 720;
  DELTAZ_TRY_ASSIGN(const std::vector<NamedView> views, viewsOf(database, width, height));
  const auto engine = makeEngine(EngineKind::kFast);
  bool kept = true;
  for (const NamedView& view : views) {
    DELTAZ_TRY_ASSIGN(const bool table_kept, printTable(*engine, database, view, settings));
    kept = kept && table_kept;
  }
  return kept;
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  for (const std::string& argument : std::vector<std::string>(argv + 1, argv + argc)) {
    if (argument == "--smoke") {
      settings.smoke = true;
    } else if (const int repeats = std::atoi(argument.c_str()); repeats > 0) {
      settings.repeats = repeats;
    } else {
      settings.area = argument;
    }
  }
  const auto kept = deltaz::run(settings);
  if (!kept.ok()) fmt::print(stderr, "bench_tolerance: error: {}\n", kept.error().message());
  return kept.ok() && kept.value() ? 0 : 1;
}
