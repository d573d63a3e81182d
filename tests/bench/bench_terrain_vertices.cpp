// What the terrain object processor costs, stage by stage.
//   bench_terrain_vertices [--smoke]
// For a node of 65 x 65 posts of a geodetic and of a projected grid it prints nanoseconds a post on every
// instruction set of this processor: positions post by post as they are defined, positions in vectors, then
// what normals and shading start from (TilePosts), normals, intensity, colours by rule, all of these together
// as lists, and the same gathered into TerrainVertices. Times: stages take turns; of each round the median of
// several batches counts, and of all rounds the least.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "libdb/access/simd_target.h"
#include "libdb/access/vertex_normals.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/objects/terrain_vertex_lists.h"
#include "tests/stress/scalar_transforms.h"
#include "tests/stress/stress_grids.h"

namespace deltaz {
namespace {

struct Settings {
  int rounds = 7, batches = 5;
  double batch_seconds = 2e-3;
};

double nanosecondsPerPost(const Settings& settings, std::size_t posts, const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> batches;
  for (int batch = 0; batch < settings.batches; ++batch) {
    int runs = 0;
    double seconds = 0;
    const Clock::time_point start = Clock::now();
    do {
      work();
      ++runs;
      seconds = std::chrono::duration<double>(Clock::now() - start).count();
    } while (seconds < settings.batch_seconds);
    batches.push_back(seconds * 1e9 / (static_cast<double>(runs) * static_cast<double>(posts)));
  }
  std::nth_element(batches.begin(), batches.begin() + settings.batches / 2, batches.end());
  return batches[static_cast<std::size_t>(settings.batches) / 2];
}

struct Stage {
  std::string name;
  std::function<void()> work;
};

void printTable(const Settings& settings, const std::string& name, const RawGrid& grid,
                const GeodeticPoint& eye) {
  const GridGeometry geometry(grid.header, grid.patches);
  const TerrainTile tile = wholeTile(grid);
  Camera camera;
  camera.eye = eye;
  camera.pitch = -20;
  const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
  Light light;
  light.to_sun = view.forward * -1;
  ViewPositions positions;
  TilePosts posts;
  VectorLists normals;
  std::vector<double> intensity;
  PostColors colors;
  TerrainVertexLists lists;
  std::vector<Vector3> scalar_positions;
  const ScalarTransform scalar(TransformKind::kExact, tile, geometry);
  const std::vector<Stage> stages = {
      {"scalar pos", [&] { scalar.apply(view, scalar_positions); }},
      {"positions", [&] { terrainViewPositions(tile, geometry, view, positions); }},
      {"prepare", [&] { posts.prepare(tile, geometry); }},
      {"normals", [&] { vertexNormals(posts, normals); }},
      {"light", [&] { terrainIntensity(normals, light, intensity); }},
      {"colours", [&] { terrainColors(posts, normals, intensity, colors); }},
      {"lists", [&] { terrainVertexLists(tile, geometry, view, light, lists); }},
      {"gathered", [&] { terrainVertices(tile, geometry, view, light); }}};
  const std::vector<SimdTarget> targets = simdTargets();
  std::vector<std::vector<double>> times(
      targets.size(), std::vector<double>(stages.size(), std::numeric_limits<double>::infinity()));
  const std::size_t count = static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
  for (int round = 0; round < settings.rounds; ++round) {
    for (std::size_t t = 0; t < targets.size(); ++t) {
      limitSimdTarget(targets[t]);
      for (std::size_t s = 0; s < stages.size(); ++s)
        times[t][s] = std::min(times[t][s], nanosecondsPerPost(settings, count, stages[s].work));
    }
  }
  limitSimdTarget(std::nullopt);
  fmt::print("\n{}, {} x {} posts: ns a post\n{:<10}", name, tile.columns, tile.rows, "");
  for (const Stage& stage : stages) fmt::print("{:>12}", stage.name);
  fmt::print("\n");
  for (std::size_t t = 0; t < targets.size(); ++t) {
    fmt::print("{:<10}", simdTargetName(targets[t]));
    for (const double time : times[t]) fmt::print("{:>12.2f}", time);
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  if (argc == 2 && std::string(argv[1]) == "--smoke") {
    settings.rounds = settings.batches = 1;
    settings.batch_seconds = 0;
  } else if (argc > 1) {
    fmt::print(stderr, "bench_terrain_vertices: error: {}: is not an option. Use --smoke\n", argv[1]);
    return 2;
  }
  deltaz::SyntheticGridOptions options;
  options.columns = options.rows = 65;
  deltaz::printTable(settings, "geodetic", deltaz::syntheticGrid(options), {43.1, -79.6, 2000});
  deltaz::printTable(settings, "projected", deltaz::projectedGrid(65, 65, 30), {46.01, 7.01, 3000});
  return 0;
}
