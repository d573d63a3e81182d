// Tables 25 to 29 of the 1983 report, ours beside the published figures.
//   bench_report [--json] [--smoke] [--repeat N]
// Tables 25, 26 and 29 are of frames of 512 x 512 pixels and 32 degrees: Table 25's scene
// (airport_scene.h) and, as the report's terrain had more faces than that scene in the frame of Table 29,
// one over samples/mt_rainier.tif, beside which its figures stand. Table 27 draws the neutral benchmark's
// copy of Table 25's scene with vertices shared by triangles and with each triangle's own. Table 28 sends the
// faces of one tile through the terrain's object processor and through the models': positions of the posts;
// the test of faces that all turn out to be back faces. Table 29 draws with and without levels of detail, by
// error and as the report did, and says what each displaces.
//
// Times are the least of interleaved rounds on one thread; the report's are of a Gould SEL 32/87, its ratios
// are what compares. A count that does not add up ends the program with 1. --json prints rows of {table,
// what, scene, unit, published, ours, ratio}.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <tbb/task_arena.h>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "librender/objects/model_object_processor.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/objects/view_positions.h"
#include "librender/raster/grid_culler.h"
#include "librender/raster/mesh_renderer.h"
#include "librender/raster/vertex_projection.h"
#include "librender/scene/conservation.h"
#include "librender/scene/render.h"
#include "librender/sweep/shown_displacement.h"
#include "librender/sweep/spread.h"
#include "tests/bench/airport_scene.h"
#include "tests/bench/peer_scenes.h"
#include "tests/support/memory_file_system.h"

namespace deltaz::bench {
namespace {

constexpr int kSide = 512;
constexpr double kFieldOfView = 32;
constexpr int kRound = 20;  // calls in a timed batch of short work

struct Row {
  int table = 0;
  std::string what, scene, unit;
  std::optional<double> published;
  double ours = 0;
};

struct Settings {
  bool json = false, smoke = false;
  int repeats = 9;
};

double millisecondsOf(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// Least milliseconds of each work, which take turns: what else the machine does only ever adds.
std::vector<double> takeTurns(const std::vector<std::function<void()>>& works, int rounds) {
  std::vector<std::vector<double>> times(works.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t k = 0; k < works.size(); ++k) {
      const double milliseconds = millisecondsOf(works[k]);
      if (round > 0) times[k].push_back(milliseconds);
    }
  }
  std::vector<double> least;
  for (const std::vector<double>& each : times) least.push_back(spreadOf(each).minimum);
  return least;
}

struct Scene {
  std::string name;
  Camera camera;
  std::uint64_t model_vertices = 0;  // of those drawn
};

struct Frame {
  FrameStatistics statistics;
  Picture picture;
};

Result<Frame> drawFrame(const Database& database, const RenderOptions& options,
                        EngineKind engine = EngineKind::kFast) {
  Frame frame;
  DELTAZ_TRY_ASSIGN(frame.picture, makeEngine(engine)->render(database, options, frame.statistics));
  if (const std::string loss = findLoss(frame.statistics); !loss.empty())
    return internalError("statistics", loss);
  return frame;
}

RenderOptions optionsOf(const Scene& scene, double tolerance) {
  RenderOptions options;
  options.camera = scene.camera;
  options.tolerance = tolerance;
  options.threads = 1;
  return options;
}

Status table25(const Database& database, const Scene& scene, std::vector<Row>& rows) {
  // As often as a front face covers a pixel's centre, hidden or not: the reference tests all of them.
  DELTAZ_TRY_ASSIGN(const Frame frame, drawFrame(database, optionsOf(scene, 0), EngineKind::kReference));
  rows.push_back({25, "terrain triangles", scene.name, "", 21000, 2.0 * kAirportColumns * kAirportRows});
  rows.push_back({25, "model triangles", scene.name, "", 3600, 1.0 * kAircraft * kAircraftTriangles});
  rows.push_back({25, "field of view", scene.name, "degrees", 32, scene.camera.field_of_view});
  rows.push_back({25, "depth complexity", scene.name, "", 1.74, frame.statistics.depth_complexity});
  return Success{};
}

Status table26(const Database& database, const Scene& scene, bool published, std::vector<Row>& rows) {
  DELTAZ_TRY_ASSIGN(const Frame frame, drawFrame(database, optionsOf(scene, 0)));
  const double total = 3.0 * static_cast<double>(frame.statistics.triangles.in);
  const double computed = static_cast<double>(frame.statistics.posts_decoded + scene.model_vertices);
  const auto of_report = [&](double value) { return published ? std::optional(value) : std::nullopt; };
  rows.push_back({26, "vertices of triangles", scene.name, "", of_report(80000), total});
  rows.push_back({26, "computed", scene.name, "", of_report(23200), computed});
  rows.push_back({26, "shared", scene.name, "%", of_report(71), 100 * (total - computed) / total});
  return Success{};
}

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

// The faces of a tile as a model's, in the local frame of its south-west post.
struct TileAsModel {
  ModelMesh mesh;
  ModelTransform to_earth = kIdentityTransform;
};

TileAsModel asModel(const TerrainTile& tile, const GridGeometry& geometry) {
  TileAsModel model;
  const Vector3 origin = geometry.placeAt(tile.first_column, tile.first_row).foot;
  model.to_earth[9] = origin.x;
  model.to_earth[10] = origin.y;
  model.to_earth[11] = origin.z;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const Vector3 p =
          geometry.placeAt(tile.first_column + i, tile.first_row + j).at(geometry.metres(tile.height(i, j))) -
          origin;
      model.mesh.vertices.push_back(
          {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
  }
  for (int j = 0; j + 1 < tile.rows; ++j) {
    for (int i = 0; i + 1 < tile.columns; ++i) {
      const auto at = [&](int di, int dj) {
        return static_cast<std::uint32_t>((j + dj) * tile.columns + i + di);
      };
      model.mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      model.mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  model.mesh.colors.assign(model.mesh.triangles.size(), {128, 128, 128});
  return model;
}

// A tile's posts on the screen, and the test of its faces by rows before any of them is set up.
class SnappedTile {
 public:
  explicit SnappedTile(const ViewPositions& positions)
      : vertices_(positions.count() + kRowPadding),
        x_(positions.count() + 2 * kRowPadding),
        y_(positions.count() + 2 * kRowPadding) {
    std::vector<Vector3> places;
    places.reserve(positions.count());
    for (std::size_t post = 0; post < positions.count(); ++post) places.push_back(positions.at(post));
    projectViewPositions(places, kSide, kSide, {vertices_.data(), x_.data(), y_.data()});
  }

  // Faces that are kept.
  std::uint64_t cull(const TerrainTile& tile) {
    const auto columns = static_cast<std::size_t>(tile.columns);
    face_.resize(2 * (columns + kRowPadding));
    tiles_.resize(face_.size());
    std::uint64_t kept = 0;
    for (std::size_t row = 0; row + 1 < static_cast<std::size_t>(tile.rows); ++row) {
      const std::size_t south = row * columns, north = south + columns;
      CulledFaces out{face_.data(), tiles_.data(), 0};
      cullGridRow({&x_[south], &y_[south], &x_[north], &y_[north], columns - 1, nullptr}, kSide, kSide, out,
                  counts_);
      kept += out.count;
    }
    return kept;
  }

  const CullCounts& counts() const { return counts_; }

 private:
  std::vector<RasterVertex> vertices_;
  std::vector<std::int32_t> x_, y_;
  std::vector<std::uint32_t> face_, tiles_;
  CullCounts counts_;
};

// The eye stands under the tile, so that both processors look at every face and keep none.
Status table28(const Settings& settings, const Database& database, std::vector<Row>& rows) {
  const int grid = 0;
  DELTAZ_TRY_ASSIGN(const std::vector<Node> leaves, nodesOfLevel(database, grid, 0));
  std::optional<TerrainTile> tile;
  for (const Node& leaf : leaves) {
    DELTAZ_TRY_ASSIGN(TerrainTile read, database.terrain(leaf));
    if (std::find(read.valid.begin(), read.valid.end(), 0) == read.valid.end() &&
        (!tile || read.heights.size() > tile->heights.size()))
      tile = std::move(read);
  }
  if (!tile) return internalError("table 28", "no tile is without voids");
  const GridGeometry& geometry = database.grid(grid);
  const TileAsModel model = asModel(*tile, geometry);
  ModelMesh vertices_only = model.mesh;
  vertices_only.triangles.clear();
  vertices_only.colors.clear();
  Camera camera;
  camera.eye = geometry.geodeticAt(tile->first_column + tile->columns / 2, tile->first_row + tile->rows / 2);
  camera.eye.height = -60000;  // all of the tile is in the picture
  camera.pitch = 90;
  camera.field_of_view = kFieldOfView;
  camera.width = camera.height = kSide;
  const ViewTransform view = makeViewTransform(camera, geometry.header().ellipsoid);
  const Light light = makeLight(database.area(), {});
  ViewPositions lists;
  terrainViewPositions(*tile, geometry, view, lists);
  SnappedTile snapped(lists);
  const double faces = static_cast<double>(model.mesh.triangles.size());
  // What is computed is looked at, so that it is computed.
  std::uint64_t kept = 0;
  double sum = 0;
  const auto batch = [](const std::function<void()>& work) {
    return [work] {
      for (int k = 0; k < kRound; ++k) work();
    };
  };
  const std::vector<double> times = takeTurns(
      {batch([&] { sum += modelFaces(vertices_only, model.to_earth, view, light).position.back().x; }),
       batch([&] { kept += modelFaces(model.mesh, model.to_earth, view, light).front.size(); }), batch([&] {
         terrainViewPositions(*tile, geometry, view, lists);
         sum += lists.u[0];
       }),
       batch([&] { kept += snapped.cull(*tile); })},
      settings.repeats);
  if (kept != 0 || snapped.counts().back_facing != snapped.counts().in || !std::isfinite(sum))
    return internalError("table 28", "faces seen from below were kept");
  const double scale = 1e6 / kRound / faces;
  const double model_transform = times[0] * scale, model_test = (times[1] - times[0]) * scale;
  const double terrain_transform = times[2] * scale, terrain_test = times[3] * scale;
  const struct {
    const char* what;
    double report_model, report_terrain, model, terrain;
  } lines[] = {{"back face elimination", 66, 11, model_test, terrain_test},
               {"viewing transformation", 70, 14, model_transform, terrain_transform},
               {"total", 136, 25, model_test + model_transform, terrain_test + terrain_transform}};
  const std::string scene = fmt::format("{:.0f} faces", faces);
  for (const auto& line : lines) {
    const std::string what = line.what;
    rows.push_back({28, what + ", models", scene, "ns/face", line.report_model * 1000, line.model});
    rows.push_back({28, what + ", terrain", scene, "ns/face", line.report_terrain * 1000, line.terrain});
    rows.push_back({28, what + ", speed-up", scene, "x", line.report_model / line.report_terrain,
                    line.model / line.terrain});
  }
  return Success{};
}

Status table29(const Settings& settings, const Database& database, const Scene& scene, bool published,
               std::vector<Row>& rows) {
  // Nothing for 0: the report says nothing of that.
  const auto of_report = [&](double value) {
    return published && value > 0 ? std::optional(value) : std::nullopt;
  };
  struct Way {
    std::string name;
    RenderOptions options;
  };
  std::vector<Way> ways = {{"no levels", optionsOf(scene, 0)}};
  RenderOptions by_range = optionsOf(scene, 1);
  by_range.lod = LodScheme::kReport;
  ways.push_back({"the report's ranges", by_range});
  for (const double tolerance : {0.5, 1.0, 2.0, 4.0, 8.0})
    ways.push_back({fmt::format("tolerance {} px", tolerance), optionsOf(scene, tolerance)});
  std::vector<std::function<void()>> draws;
  std::optional<Error> failed;
  for (const Way& way : ways) {
    draws.push_back([&] {
      if (const Result<Frame> frame = drawFrame(database, way.options); !frame.ok()) failed = frame.error();
    });
  }
  const std::vector<double> times = takeTurns(draws, settings.repeats);
  if (failed) return *failed;
  double all = 0, all_shown = 0;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const Way& way = ways[k];
    DELTAZ_TRY_ASSIGN(const Frame frame, drawFrame(database, way.options));
    DELTAZ_TRY_ASSIGN(const ShownDisplacement shown,
                      measureShownDisplacement(database, scene.camera, frame.picture, 1));
    const auto faces = static_cast<double>(frame.statistics.triangles.in);
    const auto in_picture =
        static_cast<double>(frame.statistics.triangles.no_sample + frame.statistics.triangles.drawn);
    if (k == 0) {
      all = faces;
      all_shown = in_picture;
    }
    const bool report = way.options.lod == LodScheme::kReport;
    rows.push_back({29, way.name + ": faces", scene.name, "",
                    of_report(k == 0   ? 95000
                              : report ? 27265
                                       : 0),
                    faces});
    if (report) {
      constexpr std::array<double, kReportLevels> kPublished = {10224, 5099, 2836, 3681, 2399};
      const FrameStatistics::Objects& objects = frame.statistics.objects;
      for (std::size_t level = 0; level < kPublished.size(); ++level)
        rows.push_back({29, fmt::format("  level {}", level + 1), scene.name, "",
                        of_report(kPublished[level]), static_cast<double>(objects.faces[level])});
      rows.push_back({29, "  doubly processed", scene.name, "", of_report(3026),
                      static_cast<double>(objects.faces_twice)});
    }
    if (k > 0)
      rows.push_back(
          {29, way.name + ": saved", scene.name, "x", of_report(report ? 95000.0 / 27265 : 0), all / faces});
    rows.push_back({29, way.name + ": front faces in the picture", scene.name, "", std::nullopt, in_picture});
    if (k > 0) {
      rows.push_back(
          {29, way.name + ": saved of those", scene.name, "x", std::nullopt, all_shown / in_picture});
    }
    rows.push_back({29, way.name + ": frame", scene.name, "ms", std::nullopt, times[k]});
    rows.push_back(
        {29, way.name + ": largest displacement", scene.name, "pixels", std::nullopt, shown.largest});
    rows.push_back({29, way.name + ": 99.9 % within", scene.name, "pixels", std::nullopt, shown.nearly_all});
  }
  return Success{};
}

Result<std::vector<Row>> measure(const Settings& settings) {
  std::vector<Row> rows;
  MemoryFileSystem files;
  DELTAZ_TRY(files.makeDirectory("/bench"));
  DELTAZ_TRY(buildAirport(files, "/bench/airport.dz"));
  DELTAZ_TRY_ASSIGN(const Database airport, Database::open(files, "/bench/airport.dz"));
  DELTAZ_TRY_ASSIGN(const Camera approach, airportCamera(airport, kSide, kSide));
  const Scene of_table25{"Table 25", approach, std::uint64_t{kAircraft} * kAircraftVertices};

  DELTAZ_TRY_ASSIGN(RawGrid grid, readElevationSource(DELTAZ_SAMPLES "/mt_rainier.tif", {}));
  DELTAZ_TRY(buildTerrain(files, grid, "/bench/rainier.dz", {}));
  DELTAZ_TRY_ASSIGN(const Database rainier, Database::open(files, "/bench/rainier.dz"));
  Scene over_rainier{"Rainier", approach, 0};
  over_rainier.camera.eye = {46.3, -121.5, 0};
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground, groundHeight(rainier, 46.3, -121.5));
  over_rainier.camera.eye.height = ground.value_or(0) + 500;
  over_rainier.camera.pitch = -3;
  over_rainier.camera.heading = -20;

  DELTAZ_TRY(table25(airport, of_table25, rows));
  DELTAZ_TRY(table26(airport, of_table25, true, rows));
  DELTAZ_TRY(table26(rainier, over_rainier, false, rows));
  table27(settings, rows);
  DELTAZ_TRY(table28(settings, rainier, rows));
  DELTAZ_TRY(table29(settings, airport, of_table25, false, rows));
  DELTAZ_TRY(table29(settings, rainier, over_rainier, true, rows));
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
