#include "librender/scenario/object_tables.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <utility>

#include "librender/objects/model_object_processor.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/objects/view_positions.h"
#include "librender/raster/grid_culler.h"
#include "librender/raster/vertex_projection.h"
#include "librender/scenario/airport_scene.h"
#include "librender/scene/conservation.h"
#include "librender/scene/render.h"
#include "librender/sweep/shown_displacement.h"
#include "librender/sweep/spread.h"

namespace deltaz {

namespace {

constexpr int kRound = 20;  // calls in a timed batch of short work

double millisecondsOf(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

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

RenderOptions optionsOf(const ScenarioView& scene, double tolerance) {
  RenderOptions options;
  options.camera = scene.camera;
  options.tolerance = tolerance;
  options.threads = 1;
  return options;
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
    projectViewPositions(places, kScenarioSide, kScenarioSide, {vertices_.data(), x_.data(), y_.data()});
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
      cullGridRow({&x_[south], &y_[south], &x_[north], &y_[north], columns - 1, nullptr}, kScenarioSide,
                  kScenarioSide, out, counts_);
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

}  // namespace

std::vector<double> takeTurns(const std::vector<std::function<void()>>& works, int rounds) {
  std::vector<std::vector<double>> times(works.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t k = 0; k < works.size(); ++k) {
      const double milliseconds = millisecondsOf(works[k]);
      if (round > 0) times[k].push_back(milliseconds);
    }
  }
  std::vector<double> least;
  least.reserve(times.size());
  for (const std::vector<double>& each : times) least.push_back(spreadOf(each).minimum);
  return least;
}

Status addTable25(const Database& database, const ScenarioView& scene, std::vector<ScenarioRow>& rows) {
  // As often as a front face covers a pixel's centre, hidden or not: the reference tests all of them.
  DELTAZ_TRY_ASSIGN(const Frame frame, drawFrame(database, optionsOf(scene, 0), EngineKind::kReference));
  rows.push_back({25, "terrain triangles", scene.name, "", 21000, 2.0 * kAirportColumns * kAirportRows});
  rows.push_back({25, "model triangles", scene.name, "", 3600, 1.0 * kAircraft * kAircraftTriangles});
  rows.push_back({25, "field of view", scene.name, "degrees", 32, scene.camera.field_of_view});
  rows.push_back({25, "depth complexity", scene.name, "", 1.74, frame.statistics.depth_complexity});
  return Success{};
}

Status addTable26(const Database& database, const ScenarioView& scene, bool published,
                  std::vector<ScenarioRow>& rows) {
  DELTAZ_TRY_ASSIGN(const Frame frame, drawFrame(database, optionsOf(scene, 0)));
  const double total = 3.0 * static_cast<double>(frame.statistics.triangles.in);
  const double computed = static_cast<double>(frame.statistics.posts_decoded + scene.model_vertices);
  const auto of_report = [&](double value) { return published ? std::optional(value) : std::nullopt; };
  rows.push_back({26, "vertices of triangles", scene.name, "", of_report(80000), total});
  rows.push_back({26, "computed", scene.name, "", of_report(23200), computed});
  rows.push_back({26, "shared", scene.name, "%", of_report(71), 100 * (total - computed) / total});
  return Success{};
}

// The eye stands under the tile, so that both processors look at every face and keep none.
Status addTable28(int rounds, const Database& database, std::vector<ScenarioRow>& rows) {
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
  camera.field_of_view = kScenarioFieldOfView;
  camera.width = camera.height = kScenarioSide;
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
      rounds);
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

Status addTable29(int rounds, const Database& database, const ScenarioView& scene, bool published,
                  std::vector<ScenarioRow>& rows) {
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
  draws.reserve(ways.size());
  std::optional<Error> failed;
  for (const Way& way : ways) {
    draws.push_back([&] {
      if (const Result<Frame> frame = drawFrame(database, way.options); !frame.ok()) failed = frame.error();
    });
  }
  const std::vector<double> times = takeTurns(draws, rounds);
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

}  // namespace deltaz
