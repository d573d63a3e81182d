#include "librender/fast_engine.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <utility>
#include <vector>

#include "librender/objects/border_stitcher.h"
#include "librender/objects/model_object_processor.h"
#include "librender/objects/part_meshes.h"
#include "librender/objects/report_objects.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/objects/transform_error_bound.h"
#include "librender/raster/pretiler.h"
#include "librender/raster/resolver.h"
#include "librender/raster/tiler.h"
#include "librender/scene/arena.h"
#include "librender/scene/environment.h"
#include "librender/scene/model_tree_processor.h"
#include "librender/scene/pose_table.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/stopwatch.h"
#include "librender/scene/texture_store.h"

namespace deltaz {
namespace {

// Reads and decodes the terrain of the wanted nodes; of several errors the first node's.
Result<std::vector<std::optional<TerrainTile>>> readTiles(const Database& database,
                                                          const std::vector<CutNode>& cut,
                                                          const std::vector<std::uint8_t>& wanted) {
  std::vector<std::optional<Result<TerrainTile>>> read(cut.size());
  tbb::parallel_for(std::size_t{0}, cut.size(), [&](std::size_t n) {
    if (wanted[n] != 0) read[n].emplace(database.terrain(cut[n].node));
  });
  std::vector<std::optional<TerrainTile>> tiles(cut.size());
  for (std::size_t n = 0; n < cut.size(); ++n) {
    if (!read[n]) continue;
    if (!read[n]->ok()) return read[n]->error();
    tiles[n] = std::move(*read[n]).value();
  }
  return tiles;
}

// Pixels that a transform other than exact may add. A face at a border takes posts of its neighbours, so all
// processed nodes count.
double transformError(const Database& database, const ViewTransform& view, TransformKind transform,
                      const std::vector<ProcessedNode>& processed) {
  std::vector<double> of_node(processed.size());
  tbb::parallel_for(std::size_t{0}, processed.size(), [&](std::size_t n) {
    if (processed[n].tile == nullptr) return;
    const TerrainTile& tile = *processed[n].tile;
    of_node[n] = transformPixelBound(transformErrorBound(transform, tile, database.grid(tile.grid), view),
                                     tile, processed[n].vertices->position, view);
  });
  return of_node.empty() ? 0 : *std::max_element(of_node.begin(), of_node.end());
}

Result<Picture> renderInArena(const Database& database, const RenderOptions& options,
                              FrameStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t bytes_before = database.bytesRead();
  DELTAZ_TRY_ASSIGN(const Environment environment, makeEnvironment(database, options));
  const SeamIndex seams(database);
  // Objects by range are made of full-resolution nodes.
  const bool by_range = options.lod == LodScheme::kReport;
  ScheduleOptions levels = by_range ? ScheduleOptions{.tolerance = 0, .fixed_level = -1}
                                    : ScheduleOptions{options.tolerance, options.fixed_level};
  levels.cull = options.cull;
  DELTAZ_TRY_ASSIGN(const Schedule schedule,
                    scheduleNodes(database, seams, environment.view, levels, statistics.nodes));
  statistics.level = schedule.level;
  statistics.coarsest_level = schedule.coarsest_level;
  DELTAZ_TRY_ASSIGN(const PoseTable poses, PoseTable::of(database, options.poses));
  DELTAZ_TRY_ASSIGN(const ModelSchedule models,
                    processModelTrees(modelSceneOf(database), poses, environment.view,
                                      {options.tolerance, options.fixed_level}, statistics.models));
  statistics.projected_error = by_range ? std::numeric_limits<double>::infinity()
                                        : std::max(schedule.projected_error, models.projected_error);
  statistics.milliseconds.schedule = watch.lap();

  const std::vector<CutNode>& cut = schedule.nodes;
  const CutIndex index(database, cut);
  const std::vector<std::uint8_t> wanted = nodesToProcess(cut, index, seams);
  DELTAZ_TRY_ASSIGN(const std::vector<std::optional<TerrainTile>> tiles, readTiles(database, cut, wanted));
  DELTAZ_TRY_ASSIGN(const PartMeshes meshes, PartMeshes::read(database, models.parts));
  for (const std::optional<TerrainTile>& tile : tiles) {
    if (tile)
      statistics.posts_decoded +=
          static_cast<std::uint64_t>(tile->columns) * static_cast<std::uint64_t>(tile->rows);
  }
  statistics.milliseconds.read = watch.lap();

  std::vector<TerrainVertices> vertices(cut.size());
  std::vector<ProcessedNode> processed(cut.size());
  tbb::parallel_for(std::size_t{0}, cut.size(), [&](std::size_t n) {
    if (!tiles[n]) return;
    vertices[n] = terrainVertices(*tiles[n], database.grid(tiles[n]->grid), environment.view,
                                  environment.light, options.transform);
    processed[n] = {&*tiles[n], &vertices[n]};
  });
  if (options.transform != TransformKind::kExact) {
    statistics.transform_error = transformError(database, environment.view, options.transform, processed);
    statistics.projected_error += statistics.transform_error;
  }
  const BorderStitcher stitcher(database, cut, index, seams, processed, environment.color_map != nullptr);
  const Pretiler pretiler(environment.view);
  // Nodes of the terrain from front to back, so that what lies behind is found hidden, then parts of models.
  const std::vector<std::uint32_t>& drawn = schedule.front_to_back;
  std::vector<PretiledNode> pretiled(drawn.size() + models.parts.size());
  std::vector<FrameStatistics::Triangles> of_node(pretiled.size());
  std::vector<FrameStatistics::Objects> objects(by_range ? drawn.size() : 0);
  TileBins bins;
  bins.reset(environment.view.width, environment.view.height,
             static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  const auto process = [&](std::size_t n, std::uint64_t in, std::uint64_t back_facing) {
    TileBins::Writer& writer =
        bins.writer(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()));
    writer.begin(static_cast<std::uint32_t>(n));
    pretiler.process(pretiled[n], static_cast<std::uint32_t>(n), writer);
    of_node[n] = {in, back_facing, pretiled[n].clipped, pretiled[n].no_sample, 0};
  };
  tbb::parallel_for(std::size_t{0}, drawn.size(), [&](std::size_t n) {
    const std::uint32_t of_cut = drawn[n];
    const TerrainTile& tile = *tiles[of_cut];
    TerrainSplits splits;
    TerrainVertices stitched = stitcher.vertices(of_cut, splits);
    const std::vector<std::uint8_t> replaced = seams.replacedFaces(tile);
    TerrainFaces faces = by_range ? reportFaces(tile, database.grid(tile.grid), environment.view,
                                                options.report_lod, stitched.position, replaced, objects[n])
                                  : terrainFaces(tile, stitched.position, splits, replaced);
    for (const TerrainFace& face : stitcher.seamFaces(of_cut, stitched))
      addFace(faces, stitched.position, face);
    pretiled[n] = PretiledNode::ofTerrain(cut[of_cut].node.record.grid, cut[of_cut].node.number,
                                          std::move(stitched), std::move(faces.front));
    process(n, faces.in, faces.back_facing);
  });
  tbb::parallel_for(std::size_t{0}, models.parts.size(), [&](std::size_t p) {
    const DrawnPart& part = models.parts[p];
    ModelFaces faces = modelFaces(meshes.of(p), part.to_earth, environment.view, environment.light);
    const std::uint64_t in = faces.in, back_facing = faces.back_facing;
    pretiled[drawn.size() + p] = PretiledNode::ofModel(part.instance, std::move(faces));
    process(drawn.size() + p, in, back_facing);
  });
  bins.finish();
  for (const FrameStatistics::Triangles& counts : of_node) {
    statistics.triangles.in += counts.in;
    statistics.triangles.back_facing += counts.back_facing;
    statistics.triangles.clipped += counts.clipped;
    statistics.triangles.no_sample += counts.no_sample;
  }
  for (const FrameStatistics::Objects& counts : objects) statistics.objects += counts;
  statistics.milliseconds.objects = watch.lap();

  const TiledFrame frame = tile(bins, pretiled, environment.view);
  const TilerStatistics& tiled = frame.statistics;
  statistics.triangles.drawn = tiled.faces_drawn;
  statistics.triangles.no_sample += tiled.no_sample;
  statistics.samples.tested = tiled.tested;
  statistics.samples.written = tiled.written;
  statistics.milliseconds.raster = watch.lap();

  // What is seen is settled, so only the colours that are seen are read.
  TextureStore textures;
  if (environment.color_map != nullptr) {
    DELTAZ_TRY_ASSIGN(textures,
                      TextureStore::read(*environment.color_map, visibleSquares(environment, frame)));
  }
  statistics.color_tiles = textures.tileCount();
  statistics.bytes_read = database.bytesRead() - bytes_before;
  statistics.milliseconds.read += watch.lap();

  Picture picture = makePicture(options);
  const ResolverStatistics resolved = resolve(environment, frame, textures, picture);
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
