// What real terrain costs to draw, what of it is left out and why, and how far the picture is from the truth.
//   bench_areas [--smoke] [--repeats N] [AREA.dz ...]
// Ten views of each database (samples/mt_rainier.tif, built on the spot, if none is named), 1280 x 720,
// tolerance 1 pixel: three at eye level, three oblique, two straight down, two from 200 km. For each:
// - median milliseconds of N further frames (7), levels drawn;
// - of the area's full-resolution triangles, the shares out of view, below the horizon, turned away, hidden
//   by nearer ground, and spared by coarser levels: all before a node's posts are read;
// - of the triangles that were set up, the shares back-facing, outside the picture, between the samples;
// - bytes read by opening and the first frame, as a share of the database;
// - the bound of the error and the largest displacement measured on the screen, pixels.
// Text, or with --markdown a table for a document. A displacement above 1 pixel ends the program with 1.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "librender/scene/render.h"
#include "librender/sweep/shown_displacement.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

constexpr double kTolerance = 1;
// A float depth moves what it shows by a little, most at grazing angles.
constexpr double kDepthRounding = 1e-3;

struct Settings {
  bool smoke = false, markdown = false;
  int repeats = 7;
  std::vector<std::string> areas;
};

// The eye is at these shares of the area's width and height, this high above ground or, from 200 km, above
// the ellipsoid.
struct ViewRequest {
  const char* name;
  double x, y, height, heading, pitch, field_of_view;
};

constexpr ViewRequest kViews[] = {
    {"eye level, north", 0.5, 0.35, 2, 0, 0, 60},        {"eye level, east", 0.3, 0.5, 2, 90, 0, 60},
    {"eye level, south-west", 0.65, 0.6, 2, 225, 2, 60}, {"oblique, 500 m", 0.5, 0.3, 500, 0, -8, 60},
    {"oblique, 2 km", 0.6, 0.3, 2000, 340, -18, 60},     {"oblique, 6 km", 0.4, 0.6, 6000, 160, -35, 60},
    {"down, 2 km", 0.45, 0.45, 2000, 0, -90, 60},        {"down, 10 km", 0.5, 0.5, 10000, 0, -90, 60},
    {"200 km, down", 0.5, 0.5, 200000, 0, -90, 40},      {"200 km, slanted", 0.5, -0.8, 200000, 0, -60, 40},
};

Result<Camera> cameraOf(const Database& database, const ViewRequest& request, const Settings& settings) {
  const AreaHeader& area = database.area();
  Camera camera;
  camera.eye.latitude = area.south + (area.north - area.south) * request.y;
  camera.eye.longitude = area.west + (area.east - area.west) * request.x;
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                    groundHeight(database, camera.eye.latitude, camera.eye.longitude));
  camera.eye.height = request.height + ground.value_or(area.lowest_height);
  camera.heading = request.heading;
  camera.pitch = request.pitch;
  camera.field_of_view = request.field_of_view;
  camera.width = settings.smoke ? 160 : 1280;
  camera.height = settings.smoke ? 90 : 720;
  return camera;
}

Result<std::uint64_t> bytesOf(const std::string& folder) {
  std::uint64_t sum = 0;
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> names, localFileSystem().list(folder));
  for (const std::string& name : names) {
    DELTAZ_TRY_ASSIGN(const auto file, localFileSystem().open(joinPath(folder, name)));
    sum += file->size();
  }
  return sum;
}

double percent(std::uint64_t part, std::uint64_t of) {
  return of == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(of);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Row {
  std::string view;
  double milliseconds = 0;
  FrameStatistics first;  // of a database just opened
  std::uint64_t opening_bytes = 0;
  ShownDisplacement shown;
};

Result<Row> measure(const std::string& area, const ViewRequest& request, const Settings& settings) {
  Row row;
  row.view = request.name;
  DELTAZ_TRY_ASSIGN(const Database cold, Database::open(localFileSystem(), area));
  row.opening_bytes = cold.bytesRead();
  RenderOptions options;
  options.tolerance = kTolerance;
  DELTAZ_TRY_ASSIGN(options.camera, cameraOf(cold, request, settings));
  // Where the camera stands was asked of the database that the frame is counted in.
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), area));
  const auto engine = makeEngine(EngineKind::kFast);
  DELTAZ_TRY_ASSIGN(const Picture picture, engine->render(database, options, row.first));
  std::vector<double> times;
  for (int n = 0; n < (settings.smoke ? 1 : settings.repeats); ++n) {
    FrameStatistics statistics;
    DELTAZ_TRY_ASSIGN(const Picture again, engine->render(database, options, statistics));
    times.push_back(statistics.milliseconds.total);
  }
  row.milliseconds = median(times);
  DELTAZ_TRY_ASSIGN(row.shown, measureShownDisplacement(database, options.camera, picture, 0));
  return row;
}

void printRow(const Row& row, std::uint64_t area_bytes, const Settings& settings) {
  const FrameStatistics& f = row.first;
  const FrameStatistics::FullResolution& c = f.full_resolution;
  const std::uint64_t triangles = c.sum();
  const auto share = [&](std::uint64_t part) { return fmt::format("{:.1f}", percent(part, triangles)); };
  const auto of_set_up = [&](std::uint64_t part) {
    return fmt::format("{:.1f}", percent(part, f.triangles.in));
  };
  const std::uint64_t skipped_nodes =
      f.nodes.out_of_view + f.nodes.beyond_horizon + f.nodes.facing_away + f.nodes.occluded;
  const std::vector<std::string> cells = {
      row.view,
      fmt::format("{:.1f}", row.milliseconds),
      fmt::format("{}-{}", f.level, f.coarsest_level),
      fmt::format("{} / {}", skipped_nodes, f.nodes.visited),
      share(c.out_of_view),
      share(c.beyond_horizon),
      share(c.facing_away),
      share(c.occluded),
      share(c.coarser),
      share(c.drawn),
      fmt::format("{}", f.triangles.in),
      of_set_up(f.triangles.back_facing),
      of_set_up(f.triangles.clipped),
      of_set_up(f.triangles.no_sample),
      fmt::format("{:.2f}", 100 - percent(row.opening_bytes + f.bytes_read, area_bytes)),
      fmt::format("{:.3f}", f.projected_error),
      fmt::format("{:.3f}", row.shown.largest),
  };
  constexpr int kWidths[] = {24, 8, 6, 14, 8, 8, 8, 8, 8, 8, 9, 8, 8, 8, 9, 7, 9};
  std::string line = settings.markdown ? "|" : "";
  for (std::size_t n = 0; n < cells.size(); ++n)
    line += settings.markdown ? fmt::format(" {} |", cells[n]) : fmt::format("{:>{}} ", cells[n], kWidths[n]);
  fmt::print("{}\n", line);
}

void printHead(const Settings& settings) {
  if (settings.markdown) {
    fmt::print(
        "| view | ms | levels | nodes skipped / met | out of view % | horizon % | turned away % | hidden % | "
        "coarser % | drawn % | set up | back % | outside % | no sample % | bytes unread % | bound px | "
        "measured px |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    return;
  }
  fmt::print(
      "{:>24} {:>8} {:>6} {:>14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8} {:>8} {:>9} {:>7} "
      "{:>9}\n",
      "view", "ms", "levels", "nodes skipped", "out", "horizon", "turned", "hidden", "coarser", "drawn",
      "set up", "back", "outside", "none", "unread", "bound", "measured");
}

Result<bool> measureArea(const std::string& name, const std::string& area, const Settings& settings) {
  DELTAZ_TRY_ASSIGN(const std::uint64_t bytes, bytesOf(area));
  fmt::print("\n{}: {:.1f} MB\n", name, static_cast<double>(bytes) * 1e-6);
  printHead(settings);
  bool kept = true;
  for (const ViewRequest& view : kViews) {
    DELTAZ_TRY_ASSIGN(const Row row, measure(area, view, settings));
    printRow(row, bytes, settings);
    kept = kept && row.shown.largest <= kTolerance + kDepthRounding;
  }
  return kept;
}

Result<bool> run(Settings settings) {
  const TemporaryDirectory folder;
  if (settings.areas.empty()) {
    settings.areas = {folder.file("mt_rainier.dz")};
    DELTAZ_TRY_ASSIGN(const RawGrid grid, readElevationSource(DELTAZ_SAMPLES "/mt_rainier.tif", {}));
    DELTAZ_TRY_ASSIGN(const BuildSummary summary,
                      buildTerrain(localFileSystem(), grid, settings.areas.front(), {}));
    static_cast<void>(summary);
  }
  bool kept = true;
  for (const std::string& area : settings.areas) {
    DELTAZ_TRY_ASSIGN(const bool of_area, measureArea(baseName(area), area, settings));
    kept = kept && of_area;
  }
  return kept;
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::size_t n = 0; n < arguments.size(); ++n) {
    if (arguments[n] == "--smoke") {
      settings.smoke = true;
    } else if (arguments[n] == "--markdown") {
      settings.markdown = true;
    } else if (arguments[n] == "--repeats" && n + 1 < arguments.size()) {
      settings.repeats = std::max(1, std::atoi(arguments[++n].c_str()));
    } else {
      settings.areas.push_back(arguments[n]);
    }
  }
  const auto kept = deltaz::run(settings);
  if (!kept.ok()) fmt::print(stderr, "bench_areas: error: {}\n", kept.error().message());
  return kept.ok() && kept.value() ? 0 : 1;
}
