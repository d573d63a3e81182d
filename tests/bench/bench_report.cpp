// Tables 25 to 29 of the 1983 report, ours beside the published figures.
//   bench_report [--json] [--smoke] [--repeat N]
// Tables 25, 26 and 29 are of frames of 512 x 512 pixels and 32 degrees: Table 25's scene
// (librender/scenario) and, as the report's terrain had more faces than that scene in the frame of Table 29,
// one over samples/mt_rainier.tif, beside which its figures stand. Table 27 draws the neutral benchmark's
// copy of Table 25's scene with vertices shared by triangles and with each triangle's own. Table 28 sends the
// faces of one tile through the terrain's object processor and through the models': positions of the posts;
// the test of faces that all turn out to be back faces. Table 29 draws with and without levels of detail, by
// error and as the report did, and says what each displaces.
//
// Times are the least of interleaved rounds on one thread; the report's are of a Gould SEL 32/87, its ratios
// are what compares. A count that does not add up ends the program with 1. --json prints rows of {table,
// what, scene, unit, published, ours, ratio}.
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <tbb/task_arena.h>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "librender/raster/mesh_renderer.h"
#include "librender/scenario/airport_scene.h"
#include "librender/scenario/object_tables.h"
#include "tests/bench/peer_scenes.h"
#include "tests/support/memory_file_system.h"

namespace deltaz::bench {
namespace {

constexpr int kSide = kScenarioSide;
constexpr int kRound = 20;  // calls in a timed batch of short work

using Row = ScenarioRow;

struct Settings {
  bool json = false, smoke = false;
  int repeats = 9;
};

void table27(const Settings& settings, std::vector<Row>& rows) {
  const PeerScene scene = makePeerScene("B", kSide, kSide);
  const IndexedMesh shared(scene.vertices, scene.triangles);
  MeshVertices own_vertices;
  std::vector<std::array<std::uint32_t, 3>> own_triangles;
  for (const auto& triangle : scene.triangles) {
    const auto first = static_cast<std::uint32_t>(3 * own_triangles.size());
    for (const std::uint32_t v : triangle)
      own_vertices.append(scene.vertices.x[v], scene.vertices.y[v], scene.vertices.z[v],
                          scene.vertices.rgba[v]);
    own_triangles.push_back({first, first + 1, first + 2});
  }
  own_vertices.pad();
  const IndexedMesh own(own_vertices, own_triangles);
  const ViewTransform view = scene.view();
  MeshRenderer renderer;
  ColorFrame frame;
  frame.resize(kSide, kSide);
  const auto draw = [&](const IndexedMesh& mesh) {
    return [&] {
      for (int k = 0; k < kRound; ++k) renderer.draw(view, {}, std::span(&mesh, 1), frame);
    };
  };
  std::vector<double> times;
  tbb::task_arena alone(1);
  alone.execute([&] { times = takeTurns({draw(own), draw(shared)}, settings.repeats); });
  const double scale = 1e6 / kRound / static_cast<double>(scene.triangles.size());
  rows.push_back({27, "without vertex buffer", "scene B", "ns/triangle", 36000, times[0] * scale});
  rows.push_back({27, "with vertex buffer", "scene B", "ns/triangle", 33000, times[1] * scale});
  rows.push_back({27, "savings", "scene B", "%", 8, 100 * (times[0] - times[1]) / times[0]});
}

Result<std::vector<Row>> measure(const Settings& settings) {
  std::vector<Row> rows;
  MemoryFileSystem files;
  DELTAZ_TRY(files.makeDirectory("/bench"));
  DELTAZ_TRY(buildAirport(files, "/bench/airport.dz"));
  DELTAZ_TRY_ASSIGN(const Database airport, Database::open(files, "/bench/airport.dz"));
  DELTAZ_TRY_ASSIGN(const Camera approach, airportCamera(airport, kSide, kSide));
  const ScenarioView of_table25{"Table 25", approach, std::uint64_t{kAircraft} * kAircraftVertices};

  DELTAZ_TRY_ASSIGN(RawGrid grid, readElevationSource(DELTAZ_SAMPLES "/mt_rainier.tif", {}));
  DELTAZ_TRY(buildTerrain(files, grid, "/bench/rainier.dz", {}));
  DELTAZ_TRY_ASSIGN(const Database rainier, Database::open(files, "/bench/rainier.dz"));
  ScenarioView over_rainier{"Rainier", approach, 0};
  over_rainier.camera.eye = {46.3, -121.5, 0};
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground, groundHeight(rainier, 46.3, -121.5));
  over_rainier.camera.eye.height = ground.value_or(0) + 500;
  over_rainier.camera.pitch = -3;
  over_rainier.camera.heading = -20;

  DELTAZ_TRY(addTable25(airport, of_table25, rows));
  DELTAZ_TRY(addTable26(airport, of_table25, true, rows));
  DELTAZ_TRY(addTable26(rainier, over_rainier, false, rows));
  table27(settings, rows);
  DELTAZ_TRY(addTable28(settings.repeats, rainier, rows));
  DELTAZ_TRY(addTable29(settings.repeats, airport, of_table25, false, rows));
  DELTAZ_TRY(addTable29(settings.repeats, rainier, over_rainier, true, rows));
  return rows;
}

std::string numberText(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == std::round(value) || std::abs(value) >= 1000) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}f}", value, std::abs(value) < 1 ? 3 : std::abs(value) < 100 ? 2 : 1);
}

// Table 29 as the report has it, one line a way of drawing; `rows` are those of one scene.
void printLevels(std::span<const Row> rows) {
  fmt::print("{}\n  {:<20} {:>9} {:>9} {:>7} {:>10} {:>7} {:>9} {:>9} {:>9}\n", rows.front().scene, "",
             "published", "faces", "saved", "in picture", "saved", "ms", "worst px", "99.9% px");
  const auto value = [&](const std::string& way, const char* what) -> std::string {
    for (const Row& row : rows) {
      if (row.what == way + ": " + what) return numberText(row.ours);
    }
    return "";
  };
  for (const Row& row : rows) {
    const std::size_t colon = row.what.find(": faces");
    const std::string published = row.published ? numberText(*row.published) : "";
    if (row.what.starts_with("  ")) {
      fmt::print("  {:<20} {:>9} {:>9}\n", row.what, published, numberText(row.ours));
    } else if (colon != std::string::npos) {
      const std::string way = row.what.substr(0, colon);
      fmt::print("  {:<20} {:>9} {:>9} {:>7} {:>10} {:>7} {:>9} {:>9} {:>9}\n", way, published,
                 numberText(row.ours), value(way, "saved"), value(way, "front faces in the picture"),
                 value(way, "saved of those"), value(way, "frame"), value(way, "largest displacement"),
                 value(way, "99.9 % within"));
    }
  }
}

void print(std::span<const Row> rows) {
  constexpr std::array kTitles = {"Table 25. Scenario", "Table 26. Shared vertices",
                                  "Table 27. Vertex buffer, whole frame on one thread",
                                  "Table 28. Object processors, one thread",
                                  "Table 29. Levels of detail; published: 3.48 times as few faces"};
  int table = 0;
  std::string scene;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    if (row.table != table) {
      fmt::print("\n{}\n", kTitles[static_cast<std::size_t>(row.table - 25)]);
      scene.clear();
    }
    const bool fresh = row.scene != scene;
    table = row.table;
    scene = row.scene;
    if (table == 29) {
      std::size_t end = k;
      while (end < rows.size() && rows[end].table == 29 && rows[end].scene == scene) ++end;
      printLevels(rows.subspan(k, end - k));
      k = end - 1;
      continue;
    }
    if (fresh) fmt::print("{:<42} {:>12} {:>12} {:>8}\n", scene, "published", "ours", "ratio");
    const std::string unit = row.unit.empty() ? "" : ", " + row.unit;
    fmt::print("  {:<40} {:>12} {:>12} {:>8}\n", row.what + unit,
               row.published ? numberText(*row.published) : "", numberText(row.ours),
               row.published ? fmt::format("{:.3g}", row.ours / *row.published) : "");
  }
}

void printJson(const std::vector<Row>& rows) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  for (const Row& row : rows) {
    nlohmann::ordered_json one;
    one["table"] = row.table;
    one["what"] = row.what.substr(row.what.find_first_not_of(' '));
    one["scene"] = row.scene;
    one["unit"] = row.unit;
    one["published"] = row.published ? number(*row.published) : nlohmann::ordered_json(nullptr);
    one["ours"] = number(row.ours);
    one["ratio"] = row.published ? number(row.ours / *row.published) : nlohmann::ordered_json(nullptr);
    json.push_back(std::move(one));
  }
  fmt::print("{}\n", json.dump(1));
}

}  // namespace
}  // namespace deltaz::bench

int main(int argc, char** argv) {
  deltaz::bench::Settings settings;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument == "--json") {
      settings.json = true;
    } else if (argument == "--smoke") {
      settings.smoke = true;
      settings.repeats = 1;
    } else if (argument == "--repeat" && k + 1 < argc && std::atoi(argv[k + 1]) > 0) {
      settings.repeats = std::atoi(argv[++k]);
    } else {
      fmt::print(stderr, "usage: bench_report [--json] [--smoke] [--repeat N]\n");
      return 2;
    }
  }
  const auto rows = deltaz::bench::measure(settings);
  if (!rows.ok()) {
    fmt::print(stderr, "bench_report: error: {}\n", rows.error().message());
    return 1;
  }
  settings.json ? deltaz::bench::printJson(rows.value()) : deltaz::bench::print(rows.value());
  return 0;
}
