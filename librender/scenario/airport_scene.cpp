#include "librender/scenario/airport_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/build/model_writer.h"
#include "libdb/build/place_models.h"
#include "libdb/source/synthetic_grid.h"

namespace deltaz {
namespace {

constexpr double kSouth = 47, kWest = 8;           // degrees
constexpr double kPostsPerDegree = 1200;           // 3 arc-seconds
constexpr double kMiddle = kAirportColumns / 2.0;  // the runway's column
constexpr double kThresholdRow = 10;               // posts of 92.6 m
constexpr double kRowMetres = 92.6, kColumnMetres = 63.4;
constexpr double kFloor = 300, kRidges = 330;             // metres
constexpr double kFloorHalfWidth = 4, kFloorLength = 26;  // posts

double smooth(double value) {
  const double t = std::clamp(value, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// How much of the hills stands at a post: none on the valley's floor.
double hillsAt(double column, double row) {
  const double beside = std::max(0.0, std::abs(column - kMiddle) - kFloorHalfWidth) / 18;
  const double beyond = std::max(0.0, row - kFloorLength) / 12;
  return smooth(std::hypot(beside, beyond));
}

// Ridges across the view, so that hills hide hills as in the report's frame.
double ridgesAt(double row) {
  constexpr double kApart = 10;  // posts
  return (1 - std::cos(2 * std::numbers::pi * row / kApart)) / 2;
}

RawGrid valley() {
  SyntheticGridOptions options;
  options.south = kSouth;
  options.west = kWest;
  options.spacing_latitude = options.spacing_longitude = {3, 1};
  options.columns = kAirportColumns + 1;
  options.rows = kAirportRows + 1;
  options.lowest = 0;
  options.highest = 300;
  options.seed = 25;
  RawGrid grid = syntheticGrid(options);
  for (std::int64_t row = 0; row <= kAirportRows; ++row) {
    for (std::int64_t column = 0; column <= kAirportColumns; ++column) {
      std::int32_t& height = grid.heights[static_cast<std::size_t>(row * (kAirportColumns + 1) + column)];
      height = static_cast<std::int32_t>(
          std::round(kFloor + (height + kRidges * ridgesAt(static_cast<double>(row))) *
                                  hillsAt(static_cast<double>(column), static_cast<double>(row))));
    }
  }
  return grid;
}

// A sphere of 11 bands and 15 segments, on the ground: as good a stand-in for an aircraft as any of as many
// triangles.
ModelMesh aircraft() {
  constexpr int kSegments = 15, kBands = 11;
  constexpr double kRadius = 18;
  ModelMesh mesh;
  mesh.colored_by_vertex = true;
  const auto add = [&](double band, double segment) {
    const double latitude = std::numbers::pi * (band / kBands - 0.5),
                 longitude = 2 * std::numbers::pi * segment / kSegments;
    const std::array<double, 3> normal = {std::cos(latitude) * std::cos(longitude),
                                          std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
    std::array<float, 3> vertex{};
    std::array<std::int16_t, 3> coded{};
    for (std::size_t k = 0; k < 3; ++k) {
      vertex[k] = static_cast<float>(kRadius * (normal[k] + (k == 2 ? 1 : 0)));
      coded[k] = static_cast<std::int16_t>(std::round(normal[k] * kModelNormalScale));
    }
    mesh.vertices.push_back(vertex);
    mesh.normals.push_back(coded);
    mesh.colors.push_back({220, 110, 60});
  };
  add(0, 0);
  for (int band = 1; band < kBands; ++band) {
    for (int segment = 0; segment < kSegments; ++segment) add(band, segment);
  }
  add(kBands, 0);
  const auto vertex = [](int band, int segment) {
    if (band == 0) return 0u;
    if (band == kBands) return static_cast<std::uint32_t>(1 + (kBands - 1) * kSegments);
    return static_cast<std::uint32_t>(1 + (band - 1) * kSegments + segment % kSegments);
  };
  for (int band = 0; band < kBands; ++band) {
    for (int segment = 0; segment < kSegments; ++segment) {
      const std::uint32_t a = vertex(band, segment), b = vertex(band, segment + 1),
                          c = vertex(band + 1, segment + 1), d = vertex(band + 1, segment);
      if (band > 0) mesh.triangles.push_back({a, b, c});
      if (band + 1 < kBands) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace

Status buildAirport(const FileSystem& files, const std::string& target) {
  BuildOptions options;
  options.leaf_cells = 16;
  DELTAZ_TRY(buildTerrain(files, valley(), target, options));
  FinishedPart body;
  body.name = "body";
  body.lods.push_back({aircraft(), 0});
  DELTAZ_TRY(putModel(files, target, {"aircraft", "mesh", {{"aircraft.obj", hash128({})}}, {}},
                      {{std::move(body)}, {0, 0, 0}}, false));
  std::vector<PlacementRequest> requests;
  for (int k = 0; k < kAircraft; ++k) {
    PlacementRequest request;
    const double ahead = 200 + 150 * k, aside = (k % 2 == 0 ? 1 : -1) * (40 + 12 * k);
    request.latitude = kSouth + (kThresholdRow + ahead / kRowMetres) / kPostsPerDegree;
    request.longitude = kWest + (kMiddle + aside / kColumnMetres) / kPostsPerDegree;
    request.heading = 30 * k;
    request.where = "aircraft";
    requests.push_back(request);
  }
  DELTAZ_TRY(placeModels(files, target, "aircraft", requests));
  return Success{};
}

Result<Camera> airportCamera(const Database& database, int width, int height) {
  Camera camera;
  camera.eye.latitude = kSouth + (kThresholdRow - 600 / kRowMetres) / kPostsPerDegree;
  camera.eye.longitude = kWest + kMiddle / kPostsPerDegree;
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                    groundHeight(database, camera.eye.latitude, camera.eye.longitude));
  camera.eye.height = ground.value_or(kFloor) + 100;
  camera.pitch = -4;
  camera.field_of_view = 32;
  camera.width = width;
  camera.height = height;
  return camera;
}

}  // namespace deltaz
