#include "librender/fast_engine.h"

#include <cstddef>
#include <optional>
#include <tbb/parallel_for.h>
#include <vector>

#include "librender/objects/terrain_object_processor.h"
#include "librender/raster/depth_frame_buffer.h"
#include "librender/raster/pretiler.h"
#include "librender/raster/resolver.h"
#include "librender/raster/tiler.h"
#include "librender/scene/arena.h"
#include "librender/scene/environment.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/stopwatch.h"

namespace deltaz {
namespace {

// Reads and decodes the nodes' terrain; of several errors the first node's.
Result<std::vector<TerrainTile>> readTiles(const Database& database, const std::vector<Node>& nodes) {
  std::vector<std::optional<Result<TerrainTile>>> read(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(),
                    [&](std::size_t n) { read[n].emplace(database.terrain(nodes[n])); });
  std::vector<TerrainTile> tiles;
  tiles.reserve(nodes.size());
  for (std::optional<Result<TerrainTile>>& result : read) {
    if (!result->ok()) return result->error();
    tiles.push_back(std::move(*result).value());
  }
  return tiles;
}

Result<Picture> renderInArena(const Database& database, const RenderOptions& options,
                              FrameStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t bytes_before = database.bytesRead();
  DELTAZ_TRY_ASSIGN(const Environment environment, makeEnvironment(database, options));
  DELTAZ_TRY_ASSIGN(const Schedule schedule, scheduleNodes(database, environment.view, options.tolerance,
                                                           options.fixed_level, statistics.nodes));
  statistics.level = schedule.level;
  statistics.projected_error = schedule.projected_error;
  statistics.milliseconds.schedule = watch.lap();

  DELTAZ_TRY_ASSIGN(const std::vector<TerrainTile> tiles, readTiles(database, schedule.nodes));
  for (const TerrainTile& tile : tiles)
    statistics.posts_decoded +=
        static_cast<std::uint64_t>(tile.columns) * static_cast<std::uint64_t>(tile.rows);
  statistics.bytes_read = database.bytesRead() - bytes_before;
  statistics.milliseconds.read = watch.lap();

  const Pretiler pretiler(environment.view);
  std::vector<PretiledNode> pretiled(tiles.size());
  std::vector<FrameStatistics::Triangles> of_node(tiles.size());
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t n) {
    const TerrainTile& tile = tiles[n];
    const TerrainVertices vertices =
        terrainVertices(tile, database.grid(tile.grid), environment.view, environment.light);
    const TerrainFaces faces = terrainFaces(tile, vertices.position);
    pretiler.process(vertices, faces, schedule.nodes[n].number, pretiled[n]);
    of_node[n] = {faces.in, faces.back_facing, pretiled[n].clipped, pretiled[n].no_sample, 0};
  });
  for (const FrameStatistics::Triangles& counts : of_node) {
    statistics.triangles.in += counts.in;
    statistics.triangles.back_facing += counts.back_facing;
    statistics.triangles.clipped += counts.clipped;
    statistics.triangles.no_sample += counts.no_sample;
  }
  statistics.milliseconds.objects = watch.lap();

  DepthFrameBuffer buffer(options.camera.width, options.camera.height);
  const TilerStatistics tiled = tile(pretiled, buffer);
  statistics.triangles.drawn = tiled.faces_drawn;
  statistics.triangles.no_sample += tiled.no_sample;
  statistics.samples.tested = tiled.tested;
  statistics.samples.written = tiled.written;
  statistics.milliseconds.raster = watch.lap();

  Picture picture = makePicture(options);
  const ResolverStatistics resolved = resolve(environment, pretiled, buffer, picture);
  statistics.samples.shaded = resolved.shaded;
  statistics.depth_complexity =
      resolved.covered > 0 ? static_cast<double>(tiled.tested) / static_cast<double>(resolved.covered) : 0;
  statistics.milliseconds.resolve = watch.lap();
  statistics.milliseconds.total = watch.total();
  return picture;
}

}  // namespace

Result<Picture> FastEngine::render(const Database& database, const RenderOptions& options,
                                   FrameStatistics& statistics) const {
  statistics = {};
  return drawOnThreads(options.threads, [&] { return renderInArena(database, options, statistics); });
}

}  // namespace deltaz
