#include "librender/ars/engine/stream_player.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <tbb/parallel_for.h>
#include <utility>

#include "librender/ars/engine/pixel_names.h"
#include "librender/ars/machine/machine.h"
#include "librender/ars/machine/triangle_source.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

using BatchNames = std::vector<std::vector<std::uint32_t>>;

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

// Of the triangles of a sub-image in its first pass.
PixelNames namesOf(const TriangleStream& stream, const BatchNames& names, std::uint32_t sub_image,
                   const Part& part) {
  std::vector<std::uint32_t> of_run;
  for (std::size_t b = 0; b < stream.batches.size(); ++b) {
    if (stream.batches[b].sub_image == sub_image && stream.batches[b].pass == 0)
      of_run.insert(of_run.end(), names[b].begin(), names[b].end());
  }
  return PixelNames(std::move(of_run), part.lines, part.pixels);
}

void copyNames(const PixelNames& names, const Part& part, int width, std::vector<std::uint32_t>& owner) {
  for (int i = 0; i < part.lines; ++i) {
    const auto line = static_cast<std::size_t>(part.origin.i + i) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(part.origin.j);
    for (int j = 0; j < part.pixels; ++j) owner[line + static_cast<std::size_t>(j)] = names.at(i, j);
  }
}

// `names`, if there are any, of this run.
Result<FrameRun> drawRun(const TriangleStream& stream, const ArsOptions& options, std::uint32_t sub_image,
                         int pass, PlayedStream& picture, std::optional<PixelNames>& names) {
  DELTAZ_TRY_ASSIGN(const TriangleSource source,
                    triangleSource(stream, sub_image, pass, tilerOf(stream, options)));
  DELTAZ_TRY_ASSIGN(Machine machine, Machine::make(options.machine));
  FrameRun run;
  run.sub_image = sub_image;
  run.pass = pass;
  run.triangles = source.triangles();
  if (options.timed) {
    DELTAZ_TRY_ASSIGN(run.statistics,
                      names ? machine.runTimed(NamingSource(source, *names)) : machine.runTimed(source));
    run.memory = run.statistics.memoryCounts();
  } else {
    run.memory = machine.runFunctional(source);
    if (names) takeAllNames(source, *names);
  }
  const Part part = partOf(picture, sub_image);
  if (pass == 0) copyDepths(machine, part, picture);
  copyColors(machine.readPicture(), part, picture.width, picture.color[static_cast<std::size_t>(pass)]);
  return run;
}

Result<PlayedStream> play(const TriangleStream& stream, const ArsOptions& options, const BatchNames* names,
                          StreamNames* seen) {
  DELTAZ_TRY(validate(options.machine));
  DELTAZ_TRY(checkNumberProfile(options.tiler.numbers));
  PlayedStream picture;
  picture.width = stream.picture_width;
  picture.height = stream.picture_height;
  const auto passes = static_cast<std::size_t>(stream.passes);
  picture.depth.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  picture.color.assign(passes, std::vector<std::uint8_t>(picture.depth.size()));
  if (seen != nullptr) seen->owner.assign(picture.depth.size(), kOfBackground);
  const std::size_t runs = static_cast<std::size_t>(subImageCount(picture.width, picture.height)) * passes;
  std::vector<std::optional<Result<FrameRun>>> made(runs);
  std::vector<std::optional<PixelNames>> named(runs);
  tbb::parallel_for(std::size_t{0}, runs, [&](std::size_t n) {
    const auto sub_image = static_cast<std::uint32_t>(n / passes);
    const auto pass = static_cast<int>(n % passes);
    const Part part = partOf(picture, sub_image);
    if (names != nullptr && pass == 0) named[n].emplace(namesOf(stream, *names, sub_image, part));
    made[n].emplace(drawRun(stream, options, sub_image, pass, picture, named[n]));
    if (named[n]) copyNames(*named[n], part, picture.width, seen->owner);
  });
  for (std::size_t n = 0; n < runs; ++n) {
    if (!made[n]->ok()) return made[n]->error();
    picture.runs.push_back(std::move(*made[n]).value());
    picture.drawing += picture.runs.back().statistics.duration;
    picture.reading += picture.runs.back().statistics.reading;
    if (!named[n]) continue;
    seen->pixels += named[n]->pixels();
    const std::vector<std::uint32_t> tiled = named[n]->tiled();
    seen->tiled.insert(seen->tiled.end(), tiled.begin(), tiled.end());
  }
  return picture;
}

}  // namespace

TilerConfiguration tilerOf(const TriangleStream& stream, const ArsOptions& options) {
  TilerConfiguration tiler = options.tiler;
  tiler.numbers.depth.exponent_bias = stream.profile.depth.exponent_bias;
  return tiler;
}

Result<PlayedStream> playStream(const TriangleStream& stream, const ArsOptions& options) {
  return play(stream, options, nullptr, nullptr);
}

Result<PlayedStream> playStream(const TriangleStream& stream, const ArsOptions& options,
                                const std::vector<std::vector<std::uint32_t>>& names, StreamNames& seen) {
  return play(stream, options, &names, &seen);
}

}  // namespace deltaz::ars
