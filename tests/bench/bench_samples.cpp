// Antialiasing: what samples and filters cost, and how far they are from exact integrals.
//   bench_samples [--smoke] [--json] [--area AREA.dz] [--most SAMPLES] [--repeat N] [--no-times]
// Errors are of scenes of edges (edge_scenes.h), each filter against its own exact integral over the same
// polygons: root mean squares in percent of the white. `flicker` is what the light of a thin wire, 0.4 pixel
// wide, does while the wire moves over a pixel in 32 steps, where exact integrals keep it the same: its
// standard deviation in percent. Times are medians of whole frames, 1280 x 720: of real ground
// (samples/mt_rainier.tif at 1 pixel, unless an area is named; the mean of two views), and of ground whose
// faces are hundreds of pixels large, where filling is all there is. Settings take turns, and one of one
// sample goes before each, so that ratios are medians over pairs drawn at one time.
//
// A second table says what the filters themselves do, drawn exactly: over how many pixels an upright edge
// rises from 10 to 90 percent, how far it overshoots, and how much of its peak a thin upright wire loses on
// its way from the middle of a pixel to its border.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "librender/scene/render.h"
#include "librender/sweep/spread.h"
#include "tests/bench/edge_scenes.h"
#include "tests/librender/test_databases.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

struct Settings {
  bool smoke = false, json = false, times = true;
  std::string area;
  int repeats = 7, most = 64;  // samples a pixel
};

struct Row {
  Sampling sampling;
  std::vector<double> errors;  // of the kinds of scenes, then of all
  double flicker = 0;
  double ground_ms = 0, fill_ms = 0, ground_ratio = 1, fill_ratio = 1;
};

std::vector<Sampling> samplings(const Settings& settings) {
  std::vector<Sampling> all;
  for (const int count : kSampleCounts) {
    if (count > (settings.smoke ? 4 : settings.most)) continue;
    for (const SamplePattern pattern : {SamplePattern::kOrdered, SamplePattern::kRotated}) {
      if (count == 1 && pattern == SamplePattern::kRotated) continue;
      for (const FilterKind filter : kFilterKinds) all.push_back({count, pattern, filter});
    }
  }
  return all;
}

void measureErrors(std::vector<Row>& rows, const Settings& settings) {
  std::vector<EdgeScenes> kinds = edgeScenes();
  EdgeScenes wire = movingWire();
  if (settings.smoke) {
    for (EdgeScenes& kind : kinds) kind.scenes.resize(1);
    wire.scenes.resize(4);
  }
  for (const EdgeScenes& kind : kinds) {
    std::vector<std::array<std::vector<double>, kFilterKinds.size()>> exact(kind.scenes.size());
    for (std::size_t n = 0; n < kind.scenes.size(); ++n) {
      for (const FilterKind filter : kFilterKinds)
        exact[n][static_cast<std::size_t>(filter)] = exactCoverage(kind.scenes[n], filter);
    }
    for (Row& row : rows) {
      double squares = 0;
      for (std::size_t n = 0; n < kind.scenes.size(); ++n) {
        squares += meanSquare(drawnCoverage(kind.scenes[n], row.sampling),
                              exact[n][static_cast<std::size_t>(row.sampling.filter)]);
      }
      row.errors.push_back(std::sqrt(squares / static_cast<double>(kind.scenes.size())));
    }
  }
  for (Row& row : rows) {
    double squares = 0;
    for (const double error : row.errors) squares += error * error;
    row.errors.push_back(std::sqrt(squares / static_cast<double>(row.errors.size())));
    // Of each slope by itself.
    constexpr std::size_t kSteps = 32;
    double variance = 0;
    std::size_t slopes = 0;
    for (std::size_t first = 0; first < wire.scenes.size(); first += kSteps, ++slopes) {
      const std::size_t end = std::min(first + kSteps, wire.scenes.size());
      double sum = 0, of_squares = 0;
      for (std::size_t n = first; n < end; ++n) {
        const double light = sumOf(drawnCoverage(wire.scenes[n], row.sampling));
        sum += light;
        of_squares += light * light;
      }
      const double steps = static_cast<double>(end - first), mean = sum / steps;
      if (mean > 0) variance += std::max(0.0, of_squares / steps / (mean * mean) - 1);
    }
    row.flicker = std::sqrt(variance / static_cast<double>(slopes));
  }
}

Camera cameraAt(double latitude, double longitude, double height, double heading, double pitch,
                const Settings& settings) {
  Camera camera;
  camera.eye = {latitude, longitude, height};
  camera.heading = heading;
  camera.pitch = pitch;
  camera.field_of_view = 60;
  camera.width = settings.smoke ? 160 : 1280;
  camera.height = settings.smoke ? 90 : 720;
  return camera;
}

// Over the southern part from 500 m, and steeply down on the middle.
Result<std::vector<Camera>> viewsOf(const Database& database, const Settings& settings) {
  const AreaHeader& area = database.area();
  const double south = area.south + 0.2 * (area.north - area.south);
  const double middle = (area.south + area.north) / 2, longitude = (area.west + area.east) / 2;
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground, groundHeight(database, south, longitude));
  const double height = ground.value_or(area.highest_height);
  return std::vector<Camera>{cameraAt(south, longitude, height + 500, 0, -5, settings),
                             cameraAt(middle, longitude, area.highest_height + 10000, 0, -60, settings)};
}

Status measureTimes(std::vector<Row>& rows, const Settings& settings) {
  const TemporaryDirectory folder;
  std::string path = settings.area;
  if (path.empty()) {
    path = folder.file("mt_rainier.dz");
    DELTAZ_TRY_ASSIGN(const RawGrid grid, readElevationSource(DELTAZ_SAMPLES "/mt_rainier.tif", {}));
    DELTAZ_TRY(buildTerrain(localFileSystem(), grid, path, {}));
  }
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), path));
  DELTAZ_TRY_ASSIGN(const std::vector<Camera> views, viewsOf(database, settings));
  const MemoryDatabase coarse = makeDatabase(smallArea());
  Camera over = cameraOver(coarse.database, 0.5, 0.5, 20, 30, -35, views[0].width, views[0].height);
  over.field_of_view = 60;

  struct Scene {
    const Database* database;
    Camera camera;
  };
  std::vector<Scene> scenes;
  for (const Camera& view : views) scenes.push_back({&database, view});
  scenes.push_back({&coarse.database, over});

  const auto engine = makeEngine(EngineKind::kFast);
  const auto time = [&](const Scene& scene, const Sampling& sampling) -> Result<double> {
    RenderOptions options;
    options.camera = scene.camera;
    options.sampling = sampling;
    FrameStatistics statistics;
    DELTAZ_TRY(engine->render(*scene.database, options, statistics));
    return statistics.milliseconds.total;
  };
  struct Times {
    std::vector<double> milliseconds, ratio;
  };
  std::vector<Times> times(rows.size() * scenes.size());
  const int rounds = settings.smoke ? 1 : settings.repeats + 1;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      for (std::size_t n = 0; n < scenes.size(); ++n) {
        DELTAZ_TRY_ASSIGN(const double plain, time(scenes[n], {}));
        DELTAZ_TRY_ASSIGN(const double sampled, time(scenes[n], rows[k].sampling));
        // The first round warms what there is to be warmed.
        if (round == 0 && !settings.smoke) continue;
        times[k * scenes.size() + n].milliseconds.push_back(sampled);
        times[k * scenes.size() + n].ratio.push_back(sampled / plain);
      }
    }
  }
  const double count = static_cast<double>(views.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Row& row = rows[k];
    row.ground_ratio = 0;
    for (std::size_t n = 0; n < views.size(); ++n) {
      row.ground_ms += spreadOf(times[k * scenes.size() + n].milliseconds).median / count;
      row.ground_ratio += spreadOf(times[k * scenes.size() + n].ratio).median / count;
    }
    row.fill_ms = spreadOf(times[k * scenes.size() + views.size()].milliseconds).median;
    row.fill_ratio = spreadOf(times[k * scenes.size() + views.size()].ratio).median;
  }
  return Success{};
}

struct FilterTraits {
  double rise = 0, overshoot = 0, peak_loss = 0;
};

FilterTraits traitsOf(FilterKind filter) {
  // The light right of an upright edge at x, in the pixel at 0, falls as the edge moves to the right.
  const auto light = [&](double x) {
    return analyticCoverage({{x, -50}, {50, -50}, {50, 50}, {x, 50}}, filter, 0, 0);
  };
  FilterTraits traits;
  double tenth = 0, ninth = 0;
  for (double x = -3; x < 3; x += 1.0 / 512) {
    if (light(x) >= 0.9) ninth = x;
    if (light(x) >= 0.1) tenth = x;
    traits.overshoot = std::max(traits.overshoot, light(x) - 1);
  }
  traits.rise = tenth - ninth;
  const auto wire = [&](double x) {
    return analyticCoverage({{x - 0.1, -50}, {x + 0.1, -50}, {x + 0.1, 50}, {x - 0.1, 50}}, filter, 0, 0);
  };
  traits.peak_loss = 1 - wire(0.5) / wire(0);
  return traits;
}

void printText(const std::vector<Row>& rows, const Settings& settings) {
  fmt::print("| samples | pattern | filter | edges | wires | horizon | fan | all | flicker |");
  if (settings.times) fmt::print(" ground ms | | fill ms | |");
  fmt::print("\n|--:|---|---|--:|--:|--:|--:|--:|--:|");
  if (settings.times) fmt::print("--:|--:|--:|--:|");
  fmt::print("\n");
  for (const Row& row : rows) {
    fmt::print("| {} | {} | {} |", row.sampling.count,
               row.sampling.count == 1 ? "centre" : samplePatternName(row.sampling.pattern),
               filterName(row.sampling.filter));
    for (const double error : row.errors) fmt::print(" {:.2f} |", 100 * error);
    fmt::print(" {:.2f} |", 100 * row.flicker);
    if (settings.times) {
      fmt::print(" {:.1f} | {:.2f}x | {:.1f} | {:.2f}x |", row.ground_ms, row.ground_ratio, row.fill_ms,
                 row.fill_ratio);
    }
    fmt::print("\n");
  }
  fmt::print("\n| filter | rise, px | overshoot | peak lost |\n|---|--:|--:|--:|\n");
  for (const FilterKind filter : kFilterKinds) {
    const FilterTraits traits = traitsOf(filter);
    fmt::print("| {} | {:.2f} | {:.1f} % | {:.0f} % |\n", filterName(filter), traits.rise,
               100 * traits.overshoot, 100 * traits.peak_loss);
  }
}

void printJson(const std::vector<Row>& rows, const Settings& settings) {
  fmt::print("{{\"rows\": [");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    fmt::print(
        "{}\n  {{\"samples\": {}, \"pattern\": \"{}\", \"filter\": \"{}\", \"edges\": {:.6f}, "
        "\"wires\": {:.6f}, \"horizon\": {:.6f}, \"fan\": {:.6f}, \"all\": {:.6f}, \"flicker\": {:.6f}",
        k == 0 ? "" : ",", row.sampling.count, samplePatternName(row.sampling.pattern),
        filterName(row.sampling.filter), row.errors[0], row.errors[1], row.errors[2], row.errors[3],
        row.errors[4], row.flicker);
    if (settings.times) {
      fmt::print(
          ", \"ground_ms\": {:.3f}, \"ground_ratio\": {:.3f}, \"fill_ms\": {:.3f}, \"fill_ratio\": {:.3f}",
          row.ground_ms, row.ground_ratio, row.fill_ms, row.fill_ratio);
    }
    fmt::print("}}");
  }
  fmt::print("],\n \"filters\": [");
  for (std::size_t k = 0; k < kFilterKinds.size(); ++k) {
    const FilterTraits traits = traitsOf(kFilterKinds[k]);
    fmt::print(
        "{}\n  {{\"filter\": \"{}\", \"rise_pixels\": {:.4f}, \"overshoot\": {:.5f}, "
        "\"peak_lost\": {:.5f}}}",
        k == 0 ? "" : ",", filterName(kFilterKinds[k]), traits.rise, traits.overshoot, traits.peak_loss);
  }
  fmt::print("]}}\n");
}

// Samples that are right come nearer to the integral the more they are.
bool errorsFall(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    for (const Row& other : rows) {
      if (row.sampling.pattern == other.sampling.pattern && row.sampling.filter == other.sampling.filter &&
          row.sampling.count < other.sampling.count && row.errors.back() <= other.errors.back())
        return false;
    }
  }
  return true;
}

int run(const Settings& settings) {
  std::vector<Row> rows;
  for (const Sampling& sampling : samplings(settings)) rows.push_back({sampling, {}});
  measureErrors(rows, settings);
  if (settings.times) {
    if (const Status timed = measureTimes(rows, settings); !timed.ok()) {
      fmt::print(stderr, "bench_samples: error: {}\n", timed.error().message());
      return 1;
    }
  }
  settings.json ? printJson(rows, settings) : printText(rows, settings);
  if (errorsFall(rows)) return 0;
  fmt::print(stderr, "bench_samples: more samples are not nearer to the integral\n");
  return 1;
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument == "--smoke") {
      settings.smoke = true;
    } else if (argument == "--json") {
      settings.json = true;
    } else if (argument == "--no-times") {
      settings.times = false;
    } else if (argument == "--area" && k + 1 < argc) {
      settings.area = argv[++k];
    } else if (argument == "--most" && k + 1 < argc && std::atoi(argv[k + 1]) > 0) {
      settings.most = std::atoi(argv[++k]);
    } else if (argument == "--repeat" && k + 1 < argc && std::atoi(argv[k + 1]) > 0) {
      settings.repeats = std::atoi(argv[++k]);
    } else {
      fmt::print(stderr,
                 "bench_samples: error: {} is no option: --smoke, --json, --area AREA.dz, --most SAMPLES, "
                 "--repeat N, "
                 "--no-times\n",
                 argument);
      return 2;
    }
  }
  return deltaz::run(settings);
}
