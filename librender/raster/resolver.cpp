#include "librender/raster/resolver.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <vector>

#include "librender/raster/sample_shader.h"

namespace deltaz {
namespace {

// What a worker keeps from tile to tile.
struct Worker {
  Worker(const Environment& environment, TextureStore& textures) : shader(environment, textures) {}
  SampleShader shader;
  SampleBatch batch;
  std::vector<FaceLanes> faces;
  ResolverStatistics counts;
};

void storeSamples(const SampleBatch& batch, std::size_t first_pixel, Picture& picture) {
  encodeSrgb(batch.red, batch.green, batch.blue, batch.count, &picture.rgb[3 * first_pixel]);
  float* const depth = &picture.depth[first_pixel];
  for (std::size_t n = 0; n < batch.count; ++n) depth[n] = static_cast<float>(batch.u[n]);
  std::copy_n(batch.surface, batch.count, picture.surface.begin() + static_cast<std::ptrdiff_t>(first_pixel));
  if (picture.triangle.empty()) return;
  for (std::size_t n = 0; n < batch.count; ++n) {
    if (batch.face[n] != nullptr) picture.triangle[first_pixel + n] = batch.face[n]->identity;
  }
}

// A row of a tile at a time.
void resolveTile(const TiledFrame& frame, std::size_t t, const ViewTransform& view,
                 std::span<const PretiledNode> nodes, Worker& worker, Picture& picture) {
  const SettledTile& tile = frame.tiles[t];
  makeFaceLanes(view, nodes, tile.faces(), worker.faces);
  const int first_j = static_cast<int>(t % static_cast<std::size_t>(frame.across)) * kTileSide;
  const int first_i = static_cast<int>(t / static_cast<std::size_t>(frame.across)) * kTileSide;
  const int columns = std::min(kTileSide, frame.width - first_j);
  const int rows = std::min(kTileSide, frame.height - first_i);
  static_assert(SampleBatch::kMost >= kTileSide);
  SampleBatch& batch = worker.batch;
  for (int i = 0; i < rows; ++i) {
    batch.count = static_cast<std::size_t>(columns);
    for (int j = 0; j < columns; ++j) {
      const auto n = static_cast<std::size_t>(j);
      batch.j[n] = first_j + j;
      batch.i[n] = first_i + i;
      const std::uint32_t face = tile.at(j, i);
      batch.face[n] = face == kNoTriangle ? nullptr : &worker.faces[face];
      worker.counts.covered += face == kNoTriangle ? 0 : 1;
    }
    worker.shader.shade(batch);
    for (int j = 0; j < columns; ++j)
      worker.counts.shaded += batch.face[static_cast<std::size_t>(j)] == nullptr ? 0 : 1;
    storeSamples(batch,
                 static_cast<std::size_t>(first_i + i) * static_cast<std::size_t>(frame.width) +
                     static_cast<std::size_t>(first_j),
                 picture);
  }
}

}  // namespace

ResolverStatistics resolve(const Environment& environment, const TiledFrame& frame,
                           std::span<const PretiledNode> nodes, TextureStore& textures, Picture& picture) {
  tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers(
      [&] { return std::make_unique<Worker>(environment, textures); });
  tbb::parallel_for(std::size_t{0}, frame.tiles.size(), [&](std::size_t t) {
    resolveTile(frame, t, environment.view, nodes, *workers.local(), picture);
  });
  ResolverStatistics sum;
  for (const std::unique_ptr<Worker>& worker : workers) {
    sum.covered += worker->counts.covered;
    sum.shaded += worker->counts.shaded;
  }
  return sum;
}

}  // namespace deltaz
