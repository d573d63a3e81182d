// Level of detail by error (--lod error) beside the report's by range (--lod report), in one table.
//   bench_lod [--smoke] [AREA.dz] [REPEATS]
// Renders views of a database of one grid without voids (samples/mt_rainier.tif with its voids filled, built
// on the spot, unless one is named) at full resolution, by error at several tolerances, and by range: the
// report's ranges, half and twice as long, and without double processing. Columns:
//   in         faces of the nodes or objects in view, before any is left out
//   saves      in of full resolution / in (Table 29: 3.48)
//   set up     faces that are tiled
//   twice      share of in that is the second level of objects drawn twice (Table 29: 11.1 %)
//   ms         median of a frame; frames of all rows take turns
//   kB         read for the first frame
//   error px   displacement on the screen of what pixels show: the largest, and what 99.9 % of them are
//   within cracks px  pixels that see the ground from below (tests/librender/drawn_ground.h) edges      that
//   no face beyond them shares, though there is one
// A line by error that has cracks or is farther off than its tolerance is marked, and the program ends
// with 1.
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
#include "tests/librender/drawn_ground.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

struct Settings {
  bool smoke = false;
  std::string area;
  int repeats = 9;
};

struct NamedView {
  std::string name;
  Camera camera;
};

struct Row {
  std::string name;
  RenderOptions options;
  FrameStatistics statistics;  // of the first frame of a database just opened
  std::vector<double> milliseconds;
  double displacement = 0;  // pixels, at any post
  ShownDisplacement shown;
  std::uint64_t crack_pixels = 0, unmatched_edges = 0;

  bool isReport() const { return options.lod == LodScheme::kReport; }
  double median() {
    std::sort(milliseconds.begin(), milliseconds.end());
    return milliseconds[milliseconds.size() / 2];
  }
};

// Faces of Table 29, in a typical frame of the report's.
constexpr double kReportFaces = 95000, kReportFacesByRange = 27265;

// The picture of Table 25 (32 degrees, 100 m above the ground), the same from higher, both 512 x 512 as in
// the report; and today's picture from as high, and from 10 km.
Result<std::vector<NamedView>> viewsOf(const Database& database, const Settings& settings) {
  const AreaHeader& area = database.area();
  const double longitude = (area.west + area.east) / 2;
  const double latitude = area.south + 0.1 * (area.north - area.south);
  DELTAZ_TRY_ASSIGN(const std::optional<double> found, groundHeight(database, latitude, longitude));
  const double ground = found.value_or(area.highest_height);
  const auto camera = [&](double above, double pitch, double field_of_view, int width, int height) {
    Camera result;
    result.eye = {latitude, longitude, ground + above};
    result.pitch = pitch;
    result.field_of_view = field_of_view;
    result.width = settings.smoke ? width / 2 : width;
    result.height = settings.smoke ? height / 2 : height;
    return result;
  };
  std::vector<NamedView> views = {{"100 m above ground, 32 degrees", camera(100, -3, 32, 512, 512)},
                                  {"2 km above ground, 32 degrees", camera(2000, -5, 32, 512, 512)},
                                  {"2 km above ground, 60 degrees", camera(2000, -5, 60, 1280, 720)},
                                  {"10 km above ground, 60 degrees", camera(10000, -25, 60, 1280, 720)}};
  if (settings.smoke) views = {views[1]};
  return views;
}

std::vector<Row> rowsOf(const Camera& camera, bool smoke) {
  std::vector<Row> rows;
  const auto add = [&](std::string name, LodScheme lod, double tolerance, ReportLod report) {
    Row& row = rows.emplace_back();
    row.name = std::move(name);
    row.options.camera = camera;
    row.options.lod = lod;
    row.options.tolerance = tolerance;
    row.options.report_lod = report;
  };
  add("full resolution", LodScheme::kError, 0, {});
  for (const double tolerance : smoke ? std::vector<double>{4} : std::vector<double>{0.5, 1, 2, 4, 8, 16, 64})
    add(fmt::format("error, {} pixel", tolerance), LodScheme::kError, tolerance, {});
  const ReportLod report;
  const auto ranges = [&](double share) {
    return ReportLod{report.first_range * share, report.face_reduction};
  };
  if (!smoke) add("report, every object at level 1", LodScheme::kReport, 0, ranges(1e6));
  if (!smoke) add("report, ranges x 2", LodScheme::kReport, 0, ranges(2));
  add("report", LodScheme::kReport, 0, report);
  if (!smoke) add("report, ranges x 1/2", LodScheme::kReport, 0, ranges(0.5));
  add("report, nothing drawn twice", LodScheme::kReport, 0, {report.first_range, report.face_reduction, 0});
  return rows;
}

Status measureFirstFrame(const Engine& engine, const std::string& area, const FullResolution& full,
                         Row& row) {
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), area));
  DELTAZ_TRY_ASSIGN(const Picture picture, engine.render(database, row.options, row.statistics));
  DELTAZ_TRY_ASSIGN(row.shown, measureShownDisplacement(database, row.options.camera, picture, 0));
  const ViewTransform view = makeViewTransform(row.options.camera, database.area().grids.front().ellipsoid);
  Ground ground;
  if (row.isReport()) {
    ground = groundByRange(database, view, row.options.report_lod);
    row.displacement = largestDisplacement(database, ground.faces, full, view);
  } else {
    FrameStatistics::Nodes counts;
    DELTAZ_TRY_ASSIGN(const Schedule schedule,
                      scheduleNodes(database, SeamIndex(database), view, {row.options.tolerance}, counts));
    const CutMesh mesh = meshOfCut(database, schedule, view);
    ground = groundOfCut(database, mesh, view);
    row.displacement = measureContract(database, mesh, full, view).worst_pixels;
  }
  const std::vector<std::uint8_t> below = seenFromBelow(ground, view);
  row.crack_pixels = static_cast<std::uint64_t>(std::count(below.begin(), below.end(), 1));
  row.unmatched_edges = unmatchedEdges(ground.faces);
  return Success{};
}

bool isKept(const Row& row) {
  return row.isReport() || (row.crack_pixels == 0 && row.unmatched_edges == 0 &&
                            row.displacement <= row.options.tolerance + 1e-6);
}

void printRows(std::vector<Row>& rows) {
  fmt::print("{:<32} {:>9} {:>6} {:>8} {:>6} {:>8} {:>6} {:>9} {:>8} {:>8} {:>9} {:>7}\n", "", "in", "saves",
             "set up", "twice", "ms", "kB", "error px", "seen", "99.9 %", "cracks px", "edges");
  const auto full = static_cast<double>(rows.front().statistics.triangles.in);
  for (Row& row : rows) {
    const FrameStatistics& s = row.statistics;
    const auto in = static_cast<double>(s.triangles.in);
    fmt::print(
        "{:<32} {:>9} {:>5.2f}x {:>8} {:>5.1f}% {:>8.2f} {:>6} {:>9.3f} {:>8.3f} {:>8.3f} {:>9} {:>7}{}\n",
        row.name, s.triangles.in, full / in, s.triangles.drawn,
        100 * static_cast<double>(s.objects.faces_twice) / in, row.median(), s.bytes_read / 1000,
        row.displacement, row.shown.largest, row.shown.nearly_all, row.crack_pixels, row.unmatched_edges,
        isKept(row) ? "" : "  BROKEN");
  }
  for (const Row& row : rows) {
    if (row.name != "report") continue;
    const FrameStatistics::Objects& objects = row.statistics.objects;
    fmt::print(
        "faces of levels 1 to 5: {}, drawn twice {}; Table 29: 10224, 5099, 2836, 3681, 2399, drawn twice "
        "3026, saves {:.2f}x\n",
        fmt::join(objects.faces, ", "), objects.faces_twice, kReportFaces / kReportFacesByRange);
  }
}

Result<bool> measureView(const Engine& engine, const std::string& area, const NamedView& view,
                         const Settings& settings) {
  fmt::print("\n{}, {} x {}\n", view.name, view.camera.width, view.camera.height);
  std::vector<Row> rows = rowsOf(view.camera, settings.smoke);
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), area));
  const FullResolution full(database, 0);
  for (Row& row : rows) DELTAZ_TRY(measureFirstFrame(engine, area, full, row));
  for (int round = 0; round <= settings.repeats; ++round) {
    for (Row& row : rows) {
      FrameStatistics statistics;
      DELTAZ_TRY_ASSIGN(const Picture picture, engine.render(database, row.options, statistics));
      // The first round warms the caches.
      if (round > 0) row.milliseconds.push_back(statistics.milliseconds.total);
    }
  }
  printRows(rows);
  return std::all_of(rows.begin(), rows.end(), isKept);
}

Result<bool> run(Settings settings) {
  const TemporaryDirectory folder;
  if (settings.area.empty()) {
    settings.area = folder.file("mt_rainier.dz");
    DELTAZ_TRY_ASSIGN(const RawGrid grid,
                      readElevationSource(DELTAZ_SAMPLES "/mt_rainier.tif", {.voids = VoidPolicy::kFill}));
    DELTAZ_TRY_ASSIGN(const BuildSummary summary, buildTerrain(localFileSystem(), grid, settings.area, {}));
    fmt::print("mt_rainier.tif, voids filled: {} posts, {} levels\n", summary.posts, summary.levels);
  }
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), settings.area));
  DELTAZ_TRY_ASSIGN(const std::vector<NamedView> views, viewsOf(database, settings));
  const auto engine = makeEngine(EngineKind::kFast);
  bool kept = true;
  for (const NamedView& view : views) {
    DELTAZ_TRY_ASSIGN(const bool view_kept, measureView(*engine, settings.area, view, settings));
    kept = kept && view_kept;
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
      settings.repeats = 1;
    } else if (const int repeats = std::atoi(argument.c_str()); repeats > 0) {
      settings.repeats = repeats;
    } else {
      settings.area = argument;
    }
  }
  const auto kept = deltaz::run(settings);
  if (!kept.ok()) fmt::print(stderr, "bench_lod: error: {}\n", kept.error().message());
  return kept.ok() && kept.value() ? 0 : 1;
}
