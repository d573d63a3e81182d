// How long the model of the 1983 machine takes for a frame of the report's Table 25: 24,600 triangles, about
// 456,000 pixels. Its clocks simulated and without them, one colour pass, one thread; what the machine itself
// would have taken beside it.
//
//   bench_ars [--rounds N] [--smoke]
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <vector>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/machine/machine.h"
#include "librender/ars/machine/triangle_source.h"
#include "librender/ars/tiler/triangle_encoder.h"

namespace deltaz::ars {
namespace {

constexpr int kTriangles = 24'600;

// What the owner asks of the model for this frame.
constexpr double kTimedGoal = 300, kFunctionalGoal = 20;  // milliseconds

struct Options {
  int rounds = 9;
  int triangles = kTriangles;
};

// Small triangles all over the picture, as many and as large as those of Table 25.
TriangleStream table25(int triangles, bool oversample) {
  TriangleStream stream;
  TriangleBatch batch;
  RandomNumbers random(25);
  for (int k = 0; k < triangles; ++k) {
    ProjectedTriangle corners = randomTriangle(random, {.side = oversample ? 11.2 : 15.2});
    const double depth = random.uniform(0.05, 1);
    for (ProjectedVertex& vertex : corners) {
      vertex.depth = depth * random.uniform(0.98, 1);
      vertex.color = random.uniform(20, 250);
    }
    const EncodedTriangle encoded = encodeTriangle(corners, stream.profile, {.oversample = oversample});
    batch.triangles.push_back(encodeTriangleWords(encoded.variables, stream.profile));
  }
  stream.batches.push_back(std::move(batch));
  return stream;
}

struct Times {
  double median = 0, least = 0;  // milliseconds
};

// Of the processor, so that what else the machine does counts little; the model has one thread.
Times timesOf(int rounds, const std::function<void()>& act) {
  std::vector<double> times;
  for (int round = 0; round < rounds; ++round) {
    const std::clock_t begin = std::clock();
    act();
    times.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::sort(times.begin(), times.end());
  return {.median = times[times.size() / 2], .least = times.front()};
}

bool fail(const Error& error) {
  fmt::print(stderr, "bench_ars: {}\n", error.message());
  return false;
}

bool run(const Options& options, bool oversample) {
  const TriangleStream stream = table25(options.triangles, oversample);
  fmt::print("{} triangles, {}\n", options.triangles, oversample ? "oversample" : "undersample");

  Machine functional = Machine::make({}).value();
  MemoryCounts counts;
  const Times untimed = timesOf(
      options.rounds, [&] { counts = functional.runFunctional(triangleSource(stream, 0, 0, {}).value()); });
  fmt::print("  {:<24} {:7.2f} ms (least {:.2f}, goal {:.0f}); {} pixels\n", "functional", untimed.median,
             untimed.least, kFunctionalGoal, counts.writes());
  for (const HashingMode mode :
       {HashingMode::kScramble, HashingMode::kInterleave, HashingMode::kSequential}) {
    MachineConfiguration configuration;
    configuration.mode = mode;
    Machine machine = Machine::make(configuration).value();
    Result<PassStatistics> statistics = PassStatistics{};
    const Times timed = timesOf(options.rounds, [&] {
      machine.reset();
      statistics = machine.runTimed(triangleSource(stream, 0, 0, {}).value());
    });
    if (!statistics.ok()) return fail(statistics.error());
    const PassStatistics& found = statistics.value();
    if (found.memoryCounts().writes() != counts.writes())
      return fail(internalError("bench_ars", "timed and functional runs write different pixels"));
    fmt::print(
        "  {:<24} {:7.2f} ms (least {:.2f}, goal {:.0f}); machine {:.2f} ms, {} cycles, longest queue {}\n",
        fmt::format("timed, {}", hashingModeName(mode)), timed.median, timed.least, kTimedGoal,
        static_cast<double>(found.duration) / 1e9, found.tree.cycles, found.tree.longestQueue());
  }
  return true;
}

}  // namespace
}  // namespace deltaz::ars

int main(int count, char** arguments) {
  deltaz::ars::Options options;
  for (int k = 1; k < count; ++k) {
    const std::string word = arguments[k];
    if (word == "--smoke") {
      options = {.rounds = 1, .triangles = 500};
    } else if (word == "--rounds" && k + 1 < count) {
      options.rounds = std::max(1, std::atoi(arguments[++k]));
    } else {
      fmt::print(stderr, "usage: bench_ars [--rounds N] [--smoke]\n");
      return 2;
    }
  }
  return deltaz::ars::run(options, false) && deltaz::ars::run(options, true) ? 0 : 1;
}
