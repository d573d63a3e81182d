// What a colour map costs: the texture unit beside plain Gouraud shading, speed and error together.
//   bench_texture [--smoke] [REPEATS]
// Draws one area, all of it under a colour map, at full resolution in views that are filled with ground, by
// turns with the map and with colours by rule. Columns:
//   gouraud, trilinear   ms of a frame, and ms of shading (the resolver), medians; one thread
//   ratio                trilinear / gouraud of both
//   ns                   of shading, a pixel, with the map
//   off, dB              of each, against the reference engine: pixels with a channel off by more than 2 of
//                        255, in a million, and the signal to noise ratio
// Tiles of the map are at hand, as they are from the second frame on.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "librender/sweep/picture_error.h"
#include "tests/librender/textured_area.h"

namespace deltaz {
namespace {

struct Settings {
  int width = 1280, height = 720, repeats = 15;
};

struct Shading {
  RenderOptions options;
  std::vector<double> total, resolve;
  Picture picture;
  PictureError error;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Stripes and patches of all sizes, all of them opaque.
std::array<std::uint8_t, 4> patchwork(std::uint16_t /*grid*/, double column, double row) {
  const auto x = static_cast<int>(column * 8), y = static_cast<int>(row * 8);
  return {static_cast<std::uint8_t>(60 + (x * 7 + y) % 120), static_cast<std::uint8_t>(90 + (x ^ y) % 90),
          static_cast<std::uint8_t>((x / 16 + y / 16) % 2 == 0 ? 70 : 110), 255};
}

void measure(const Settings& settings) {
  const MemoryDatabase area = makeTexturedDatabase({syntheticGrid(smallArea())}, 16, 0, patchwork);
  struct View {
    const char* name;
    Camera camera;
  };
  const std::vector<View> views = {
      {"straight down", cameraOver(area.database, 0.5, 0.5, 700, 20, -90, settings.width, settings.height)},
      {"oblique", cameraOver(area.database, 0.5, 0.2, 500, 10, -45, settings.width, settings.height)},
      {"along the ground", cameraOver(area.database, 0.5, 0.1, 60, 5, -20, settings.width, settings.height)}};
  fmt::print("{:<18}{:>9}{:>16}{:>18}{:>16}{:>8}{:>16}{:>16}\n", "view", "ground", "gouraud, ms",
             "trilinear, ms", "ratio", "ns", "gouraud off/dB", "trilinear off/dB");
  for (const View& view : views) {
    Shading gouraud, trilinear;
    for (Shading* const shading : {&gouraud, &trilinear}) {
      shading->options.camera = view.camera;
      shading->options.tolerance = 0;
      shading->options.threads = 1;
      shading->options.color_map = shading == &gouraud ? std::string(kNoColorMap) : kTestColorMap;
    }
    const std::unique_ptr<Engine> engine = makeEngine(EngineKind::kFast);
    std::uint64_t shaded = 0;
    for (int round = 0; round <= settings.repeats; ++round) {
      for (Shading* const shading : {&gouraud, &trilinear}) {
        FrameStatistics statistics;
        Result<Picture> picture = engine->render(area.database, shading->options, statistics);
        if (!picture.ok()) {
          fmt::print(stderr, "bench_texture: error: {}\n", picture.error().message());
          std::exit(1);
        }
        shading->picture = std::move(picture).value();
        shaded = statistics.samples.shaded;
        // The first round reads the map.
        if (round == 0 && settings.repeats > 0) continue;
        shading->total.push_back(statistics.milliseconds.total);
        shading->resolve.push_back(statistics.milliseconds.resolve);
      }
    }
    for (Shading* const shading : {&gouraud, &trilinear})
      shading->error =
          comparePictures(shading->picture, draw(EngineKind::kReference, area.database, shading->options));
    const double pixels = static_cast<double>(settings.width) * settings.height;
    const auto times = [](const Shading& shading) {
      return fmt::format("{:.1f} / {:.1f}", median(shading.total), median(shading.resolve));
    };
    const auto error = [](const Shading& shading) {
      return fmt::format("{:.0f} / {:.1f}", shading.error.differingShare() * 1e6,
                         shading.error.peakSignalToNoise());
    };
    fmt::print("{:<18}{:>7.0f} %{:>16}{:>18}{:>16}{:>8.1f}{:>16}{:>16}\n", view.name,
               100 * static_cast<double>(shaded) / pixels, times(gouraud), times(trilinear),
               fmt::format("{:.2f} / {:.2f}", median(trilinear.total) / median(gouraud.total),
                           median(trilinear.resolve) / median(gouraud.resolve)),
               median(trilinear.resolve) * 1e6 / pixels, error(gouraud), error(trilinear));
  }
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  if (argc == 2 && std::string(argv[1]) == "--smoke") {
    settings = {160, 90, 0};
  } else if (argc == 2 && std::atoi(argv[1]) > 0) {
    settings.repeats = std::atoi(argv[1]);
  } else if (argc > 1) {
    fmt::print(stderr, "bench_texture: error: {}: is neither --smoke nor a number of repeats\n", argv[1]);
    return 2;
  }
  deltaz::measure(settings);
  return 0;
}
