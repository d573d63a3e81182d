#include "librender/ars/engine/ars_engine.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <optional>

#include "librender/ars/antialiaser/shift_add_filter.h"
#include "librender/ars/engine/ars_frame.h"
#include "librender/ars/engine/frame_stream.h"
#include "librender/ars/engine/stream_player.h"
#include "librender/scene/arena.h"
#include "librender/scene/stopwatch.h"

namespace deltaz {
namespace {

Status checkMachineCan(const RenderOptions& options) {
  if (!options.sampling.isPlain()) {
    return usageError("--samples", "the machine takes one sample a pixel, and has an antialiaser of its own",
                      {}, "Leave out --samples and --filter, and give --ars antialiaser=report");
  }
  if (options.lod != LodScheme::kError)
    return usageError("--lod", "the machine draws levels of detail by error", {}, "Leave out --lod report");
  if (options.transform != TransformKind::kExact)
    return usageError("--transform", "the machine is handed exact positions", {}, "Leave out --transform");
  DELTAZ_TRY(ars::validate(options.ars.machine));
  return ars::checkNumberProfile(options.ars.tiler.numbers);
}

// Where the samples lie that pixels are made of.
struct SampleRaster {
  std::optional<ars::ShiftAddKernel> kernel;
  int ratio = 1;
  double first_centre = 0;  // of pixel 0, in samples

  double centre(int pixel) const { return ratio * pixel + first_centre; }
  int nearest(int pixel, int samples) const {
    return std::clamp(static_cast<int>(std::lround(centre(pixel))), 0, samples - 1);
  }
};

Result<SampleRaster> sampleRaster(const ArsOptions& options) {
  SampleRaster raster;
  if (options.antialiaser.empty()) return raster;
  raster.kernel = ars::shiftAddKernelNamed(options.antialiaser);
  if (!raster.kernel)
    return usageError("--ars antialiaser", fmt::format("there is no kernel '{}'", options.antialiaser));
  raster.ratio = raster.kernel->ratio;
  raster.first_centre = raster.kernel->firstSample(0) + (raster.kernel->taps() - 1) / 2.0;
  return raster;
}

// The view through the samples, and what the scene is in it.
struct SampledScene {
  SampleRaster raster;
  Environment environment;
  ars::SceneTriangles triangles;
};

Result<SampledScene> sampledScene(const Database& database, const RenderOptions& asked,
                                  FrameStatistics& statistics) {
  DELTAZ_TRY(checkMachineCan(asked));
  DELTAZ_TRY_ASSIGN(const SampleRaster raster, sampleRaster(asked.ars));
  RenderOptions options = asked;
  options.camera.width *= raster.ratio;
  options.camera.height *= raster.ratio;
  options.tolerance *= raster.ratio;
  DELTAZ_TRY_ASSIGN(Environment environment, makeEnvironment(database, options));
  ViewTransform& view = environment.view;
  view.centre_j = raster.first_centre + raster.ratio * (asked.camera.width - 1) / 2.0;
  view.centre_i = raster.first_centre + raster.ratio * (asked.camera.height - 1) / 2.0;
  DELTAZ_TRY_ASSIGN(ars::SceneTriangles triangles,
                    ars::sceneTriangles(database, environment, options, statistics));
  statistics.projected_error /= raster.ratio;
  return SampledScene{raster, environment, std::move(triangles)};
}

// The picture that is shown of the samples.
Picture shownPicture(const SampledScene& scene, const RenderOptions& asked, const ars::DepthFormat& depths,
                     const ars::PlayedStream& samples, const std::vector<std::uint32_t>& owners) {
  Picture picture = makePicture(asked);
  std::vector<std::vector<std::uint8_t>> colors;
  for (const std::vector<std::uint8_t>& color : samples.color) {
    colors.push_back(scene.raster.kernel
                         ? ars::filtered(*scene.raster.kernel, color, samples.width, samples.height)
                         : color);
  }
  for (int i = 0; i < picture.height; ++i) {
    for (int j = 0; j < picture.width; ++j) {
      const std::size_t pixel =
          static_cast<std::size_t>(i) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(j);
      for (std::size_t c = 0; c < ars::kColors; ++c)
        picture.rgb[3 * pixel + c] = colors[colors.size() == 1 ? 0 : c][pixel];
      const std::size_t sample = static_cast<std::size_t>(scene.raster.nearest(i, samples.height)) *
                                     static_cast<std::size_t>(samples.width) +
                                 static_cast<std::size_t>(scene.raster.nearest(j, samples.width));
      if (samples.depth[sample].written) {
        const double inverse_u = depths.decode(samples.depth[sample].depth);
        picture.depth[pixel] =
            inverse_u > 0 ? static_cast<float>(1 / inverse_u) : std::numeric_limits<float>::infinity();
        const std::uint32_t owner = owners[sample];
        picture.surface[pixel] = owner < scene.triangles.terrain ? Surface::kTerrain : Surface::kModel;
        if (asked.keep_triangle_ids) picture.triangle[pixel] = scene.triangles.identity[owner];
        continue;
      }
      const double u = scene.environment.sea.depth(
          scene.environment.view.ray(scene.raster.centre(j), scene.raster.centre(i)));
      const bool sea = u < std::numeric_limits<double>::infinity();
      picture.surface[pixel] = sea ? Surface::kSea : Surface::kSky;
      picture.depth[pixel] = static_cast<float>(u);
    }
  }
  return picture;
}

void countTriangles(const ars::FrameStream& frame, const ars::StreamNames& seen,
                    FrameStatistics::Triangles& counts) {
  std::vector<std::uint8_t> tiled(frame.on_screen.size());
  for (const std::uint32_t name : seen.tiled) tiled[name] = 1;
  for (std::size_t t = 0; t < tiled.size(); ++t)
    ++(tiled[t] != 0 ? counts.drawn : frame.on_screen[t] != 0 ? counts.no_sample : counts.clipped);
}

// Leaves the stream in `recorded` if that is asked for.
Result<Picture> renderInArena(const Database& database, const RenderOptions& asked,
                              FrameStatistics& statistics, ars::TriangleStream* recorded) {
  Stopwatch watch;
  const std::uint64_t bytes_before = database.bytesRead();
  DELTAZ_TRY_ASSIGN(const SampledScene scene, sampledScene(database, asked, statistics));
  statistics.bytes_read = database.bytesRead() - bytes_before;
  watch.lap();
  const ArsOptions& options = asked.ars;
  ars::FrameStream frame = ars::makeFrameStream(scene.triangles, scene.environment, options);

  const int width = frame.stream.picture_width, height = frame.stream.picture_height;
  statistics.milliseconds.objects += watch.lap();

  auto report = std::make_shared<ars::Frame>();
  report->picture_width = width;
  report->picture_height = height;
  report->sub_images = ars::subImageCount(width, height);
  report->passes = options.passes;
  report->timed = options.timed;
  report->settings = effectiveArsOptions(options);
  report->pretiler = frame.counts;
  for (const ars::TriangleBatch& batch : frame.stream.batches) {
    if (batch.pass == 0 && batch.phase == ars::DrawPhase::kBackground)
      report->background += batch.triangles.size();
  }
  ars::StreamNames seen;
  DELTAZ_TRY_ASSIGN(ars::PlayedStream samples, ars::playStream(frame.stream, options, frame.owner, seen));
  report->runs = std::move(samples.runs);
  report->drawing = samples.drawing;
  report->reading = samples.reading;
  statistics.milliseconds.raster = watch.lap();

  Picture picture = shownPicture(scene, asked, ars::frameNumbers(options).depth, samples, seen.owner);
  countTriangles(frame, seen, statistics.triangles);
  statistics.samples.tested = seen.pixels;
  statistics.samples.shaded = static_cast<std::uint64_t>(std::count_if(
      seen.owner.begin(), seen.owner.end(), [](std::uint32_t n) { return n != ars::kOfBackground; }));
  for (const ars::FrameRun& run : report->runs) {
    if (run.pass != 0) continue;
    for (const ars::MemoryCycle cycle : {ars::MemoryCycle::kInitialize, ars::MemoryCycle::kLookAheadWrite,
                                         ars::MemoryCycle::kReadCompareWrite})
      statistics.samples.written +=
          static_cast<std::uint64_t>(run.memory.cycles[static_cast<std::size_t>(cycle)]);
  }
  if (statistics.samples.shaded > 0)
    statistics.depth_complexity =
        static_cast<double>(statistics.samples.tested) / static_cast<double>(statistics.samples.shaded);
  statistics.ars = std::move(report);
  if (recorded != nullptr) *recorded = std::move(frame.stream);
  statistics.milliseconds.resolve = watch.lap();
  statistics.milliseconds.total = watch.total();
  return picture;
}

}  // namespace

Result<Picture> ArsEngine::render(const Database& database, const RenderOptions& options,
                                  FrameStatistics& statistics) const {
  statistics = {};
  return drawOnThreads(options.threads,
                       [&] { return renderInArena(database, options, statistics, nullptr); });
}

Result<RecordedFrame> renderAndRecord(const Database& database, const RenderOptions& options,
                                      FrameStatistics& statistics) {
  statistics = {};
  RecordedFrame frame;
  DELTAZ_TRY_ASSIGN(frame.picture, drawOnThreads(options.threads, [&] {
                      return renderInArena(database, options, statistics, &frame.stream);
                    }));
  return frame;
}

}  // namespace deltaz
