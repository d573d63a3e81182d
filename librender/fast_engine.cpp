#include "librender/fast_engine.h"

#include <algorithm>
#include <limits>

#include "librender/antialias/sample_grid.h"
#include "librender/antialias/sample_resolver.h"
#include "librender/frame_drawer.h"
#include "librender/raster/resolver.h"
#include "librender/scene/arena.h"
#include "librender/scene/environment.h"
#include "librender/scene/model_tree_processor.h"
#include "librender/scene/pose_table.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/stopwatch.h"
#include "librender/scene/texture_store.h"

namespace deltaz {
namespace {

HiddenNodes hiddenNodes(const RenderOptions& options, const SeamIndex& seams) {
  if (!options.cull || !options.occlusion) return HiddenNodes::kDrawn;
  // What other transforms, and objects by range, draw is not bound to the nodes' volumes; nor are the borders
  // of a fixed level beside seams, which are at full resolution.
  if (options.lod != LodScheme::kError || options.transform != TransformKind::kExact)
    return HiddenNodes::kDrawn;
  if (options.fixed_level > 0 && !seams.empty()) return HiddenNodes::kDrawn;
  return HiddenNodes::kNotOpened;
}

Result<Picture> renderInArena(const Database& database, const RenderOptions& asked, FrameScratch& scratch,
                              TextureCache& cache, FrameStatistics& statistics) {
  DELTAZ_TRY(checkSampling(asked));
  // All but the resolver draws the sample grid.
  const RenderOptions options = onSampleGrid(asked);
  Stopwatch watch;
  const std::uint64_t bytes_before = database.bytesRead();
  DELTAZ_TRY_ASSIGN(const Environment environment, makeEnvironment(database, options));
  const SeamIndex seams(database);
  // Objects by range are made of full-resolution nodes.
  const bool by_range = options.lod == LodScheme::kReport;
  ScheduleOptions levels = by_range ? ScheduleOptions{.tolerance = 0, .fixed_level = -1}
                                    : ScheduleOptions{options.tolerance, options.fixed_level};
  levels.cull = options.cull;
  FrameDrawer drawer(database, seams, environment, options, scratch, statistics, watch);
  const HiddenNodes hidden = hiddenNodes(options, seams);
  Scheduler scheduler(database, seams, environment.view, levels, statistics.nodes);
  DELTAZ_TRY(drawer.drawTerrain(scheduler, hidden));
  const Schedule schedule = scheduler.finish();
  statistics.level = schedule.level;
  statistics.coarsest_level = schedule.coarsest_level;
  statistics.full_resolution = schedule.full_resolution;

  DELTAZ_TRY_ASSIGN(const PoseTable poses, PoseTable::of(database, options.poses));
  DELTAZ_TRY_ASSIGN(const ModelSchedule models,
                    processModelTrees(modelSceneOf(database), poses, environment.view,
                                      {options.tolerance, options.fixed_level}, statistics.models));
  statistics.milliseconds.schedule += watch.lap();
  DELTAZ_TRY(drawer.drawModels(models, hidden != HiddenNodes::kDrawn));
  statistics.projected_error = by_range ? std::numeric_limits<double>::infinity()
                                        : std::max(schedule.projected_error, models.projected_error);
  statistics.projected_error += statistics.transform_error;
  const double samples_across = samplesAcross(asked.sampling.count);
  statistics.projected_error /= samples_across;
  statistics.transform_error /= samples_across;
  const TiledFrame& frame = drawer.settle();

  Picture picture = makePicture(asked);
  // What is seen is settled, so only the colours that are seen are read.
  TextureStore textures(environment.color_map, &cache);
  const ResolverStatistics resolved =
      asked.sampling.isPlain()
          ? resolve(environment, frame, drawer.nodes(), textures, picture)
          : resolveSamples(environment, frame, drawer.nodes(), asked.sampling, textures, picture);
  DELTAZ_TRY(textures.status());
  statistics.color_tiles = textures.tileCount();
  statistics.bytes_read = database.bytesRead() - bytes_before;
  statistics.samples.shaded = resolved.shaded;
  statistics.depth_complexity = resolved.covered > 0 ? static_cast<double>(statistics.samples.tested) /
                                                           static_cast<double>(resolved.covered)
                                                     : 0;
  statistics.milliseconds.resolve = watch.lap();
  statistics.milliseconds.total = watch.total();
  return picture;
}

}  // namespace

Result<Picture> FastEngine::render(const Database& database, const RenderOptions& options,
                                   FrameStatistics& statistics) const {
  statistics = {};
  const FrameScratchPool::Lease scratch(scratches_);
  return drawOnThreads(options.threads,
                       [&] { return renderInArena(database, options, *scratch, textures_, statistics); });
}

}  // namespace deltaz
