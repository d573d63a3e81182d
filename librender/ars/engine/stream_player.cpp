#include "librender/ars/engine/stream_player.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <tbb/parallel_for.h>

#include "librender/ars/machine/machine.h"
#include "librender/ars/machine/triangle_source.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

// The part of the screen that is in the picture.
struct Part {
  SubImageOrigin origin;
  int lines = 0, pixels = 0;
};

Part partOf(const PlayedStream& picture, std::uint32_t sub_image) {
  const SubImageOrigin origin = subImageOrigin(sub_image, picture.width);
  return {origin, std::min(kScreenLines, picture.height - origin.i),
          std::min(kScreenPixels, picture.width - origin.j)};
}

void copyDepths(const Machine& machine, const Part& part, PlayedStream& picture) {
  for (int i = 0; i < part.lines; ++i) {
    const auto line = static_cast<std::size_t>(part.origin.i + i) * static_cast<std::size_t>(picture.width) +
                      static_cast<std::size_t>(part.origin.j);
    for (int j = 0; j < part.pixels; ++j)
      picture.depth[line + static_cast<std::size_t>(j)] = {machine.depth(i, j), machine.written(i, j)};
  }
}

void copyColors(const std::vector<std::uint8_t>& screen, const Part& part, int width,
                std::vector<std::uint8_t>& color) {
  for (int i = 0; i < part.lines; ++i) {
    const auto from = screen.begin() + static_cast<std::ptrdiff_t>(i) * kScreenPixels;
    std::copy(from, from + part.pixels,
              color.begin() + static_cast<std::ptrdiff_t>(part.origin.i + i) * width + part.origin.j);
  }
}

Result<FrameRun> drawRun(const TriangleStream& stream, const ArsOptions& options, std::uint32_t sub_image,
                         int pass, PlayedStream& picture) {
  DELTAZ_TRY_ASSIGN(const TriangleSource source,
                    triangleSource(stream, sub_image, pass, tilerOf(stream, options)));
  DELTAZ_TRY_ASSIGN(Machine machine, Machine::make(options.machine));
  FrameRun run;
  run.sub_image = sub_image;
  run.pass = pass;
  run.triangles = source.triangles();
  if (options.timed) {
    DELTAZ_TRY_ASSIGN(run.statistics, machine.runTimed(source));
    run.memory = run.statistics.memoryCounts();
  } else {
    run.memory = machine.runFunctional(source);
  }
  const Part part = partOf(picture, sub_image);
  if (pass == 0) copyDepths(machine, part, picture);
  copyColors(machine.readPicture(), part, picture.width, picture.color[static_cast<std::size_t>(pass)]);
  return run;
}

}  // namespace

TilerConfiguration tilerOf(const TriangleStream& stream, const ArsOptions& options) {
  TilerConfiguration tiler = options.tiler;
  tiler.numbers.depth.exponent_bias = stream.profile.depth.exponent_bias;
  return tiler;
}

Result<PlayedStream> playStream(const TriangleStream& stream, const ArsOptions& options) {
  DELTAZ_TRY(validate(options.machine));
  DELTAZ_TRY(checkNumberProfile(options.tiler.numbers));
  PlayedStream picture;
  picture.width = stream.picture_width;
  picture.height = stream.picture_height;
  const auto passes = static_cast<std::size_t>(stream.passes);
  picture.depth.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  picture.color.assign(passes, std::vector<std::uint8_t>(picture.depth.size()));
  const std::size_t runs = static_cast<std::size_t>(subImageCount(picture.width, picture.height)) * passes;
  std::vector<std::optional<Result<FrameRun>>> made(runs);
  tbb::parallel_for(std::size_t{0}, runs, [&](std::size_t n) {
    made[n].emplace(drawRun(stream, options, static_cast<std::uint32_t>(n / passes),
                            static_cast<int>(n % passes), picture));
  });
  for (std::optional<Result<FrameRun>>& run : made) {
    if (!run->ok()) return run->error();
    picture.runs.push_back(std::move(*run).value());
    picture.drawing += picture.runs.back().statistics.duration;
    picture.reading += picture.runs.back().statistics.reading;
  }
  return picture;
}

}  // namespace deltaz::ars
