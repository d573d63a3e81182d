// The rasteriser by itself against other CPU renderers, on the neutral benchmark's triangles: a table of
// milliseconds a frame, ratios to llvmpipe taken round by round in one run (so that what else the machine
// does hits all alike), and each picture's error against exact rays. Frame = clear, draw, finish; Gouraud,
// single-precision depth, back faces dropped, buffers resident.
//
//   bench_core [--rounds N] [--scene NAME]... [--size 512|1080] [--simd NAME] [--json] [--smoke]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <vector>

#include "libdb/access/simd_target.h"
#include "librender/raster/mesh_renderer.h"

#include "exact_rays.h"
#include "peers.h"

namespace deltaz::bench {
namespace {

constexpr int kThreads = 2;

// What the goal asks of the rasteriser with two threads, as a multiple of llvmpipe's speed with two.
struct Goal {
  const char* scene;
  int width;
  double ratio;
  double scaling;  // from one thread to two
};
constexpr Goal kGoals[] = {{"A", 512, 21, 1.8},           {"B", 512, 8, 1.5},
                           {"C-small-8", 512, 10, 1.8},   {"C-large-8", 512, 3.2, 1.8},
                           {"A", 1920, 8.9, 1.8},         {"B", 1920, 5.7, 1.8},
                           {"C-small-8", 1920, 7.7, 1.8}, {"C-large-8", 1920, 3.9, 1.8}};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double millisecondsOf(const std::function<void()>& act) {
  const auto begin = std::chrono::steady_clock::now();
  act();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

struct Row {
  std::string name;
  std::function<void()> frame;
  std::function<std::vector<std::uint32_t>()> picture;
  double preparation = 0;
  std::vector<double> milliseconds = {};
  std::vector<double> ratio = {};  // llvmpipe's time over this one's, round by round
};

struct Options {
  int rounds = 15;
  std::vector<std::string> scenes;
  int size = 0;
  bool json = false, smoke = false;
};

nlohmann::json benchScene(const std::string& name, int width, int height, const Options& options,
                          bool with_error) {
  const PeerScene scene = makePeerScene(name, width, height);
  const std::vector<GridMesh> grids = scene.grids();
  std::vector<IndexedMesh> meshes;
  const double preparation = millisecondsOf([&] { meshes = scene.meshes(); });
  const ViewTransform view = scene.view();
  ColorFrame frame;
  frame.background = kPeerBackground;
  frame.resize(width, height);
  MeshRenderer renderer;
  MeshCounts counts;
  tbb::task_arena one(1), two(kThreads);

  std::vector<Row> rows;
  const std::unique_ptr<Peer> llvmpipe = makeLlvmpipe(scene);
  const std::unique_ptr<Peer> embree = makeEmbree(scene, kThreads);
  if (llvmpipe != nullptr)
    rows.push_back({"llvmpipe", [&] { llvmpipe->frame(); }, [&] { return llvmpipe->picture(); }});
  if (embree != nullptr)
    rows.push_back(
        {embree->name(), [&] { embree->frame(); }, [&] { return embree->picture(); }, embree->preparation()});
  const auto ours = [&](tbb::task_arena& arena) {
    return [&] { arena.execute([&] { counts = renderer.draw(view, grids, meshes, frame); }); };
  };
  const auto our_picture = [&] { return std::vector<std::uint32_t>(frame.rgba.begin(), frame.rgba.end()); };
  rows.push_back({"deltaz, 1 thread", ours(one), our_picture, preparation});
  rows.push_back({fmt::format("deltaz, {} threads", kThreads), ours(two), our_picture, preparation});

  for (Row& row : rows) row.frame();
  // Cheap renderers are timed several times a round. The first frame of each renderer's turn is not: it
  // finds the caches full of another's data and its threads asleep.
  for (int round = 0; round < options.rounds; ++round) {
    double of_llvmpipe = 0;
    for (Row& row : rows) {
      std::vector<double> of_round;
      double spent = 0;
      if (!options.smoke) row.frame();
      do {
        of_round.push_back(millisecondsOf(row.frame));
        spent += of_round.back();
      } while (of_round.size() < 15 && spent < 20 && !options.smoke);
      const double here = median(of_round);
      row.milliseconds.push_back(here);
      if (row.name == "llvmpipe") of_llvmpipe = here;
      if (of_llvmpipe > 0) row.ratio.push_back(of_llvmpipe / here);
    }
  }

  std::optional<ExactPicture> exact;
  if (with_error) exact = traceExactly(scene);
  nlohmann::json result = {
      {"scene", name}, {"width", width}, {"height", height}, {"rows", nlohmann::json::array()}};
  std::vector<double> scalings;
  for (std::size_t round = 0; round < rows.back().milliseconds.size(); ++round)
    scalings.push_back(rows[rows.size() - 2].milliseconds[round] / rows.back().milliseconds[round]);
  const double scaling = median(scalings);
  for (Row& row : rows) {
    row.frame();
    nlohmann::json line = {{"renderer", row.name},
                           {"ms", median(row.milliseconds)},
                           {"min_ms", *std::min_element(row.milliseconds.begin(), row.milliseconds.end())},
                           {"preparation_ms", row.preparation},
                           {"ratio_to_llvmpipe", median(row.ratio)}};
    if (exact) {
      const PictureError error = compareWith(*exact, row.picture());
      line["coverage_mismatches"] = error.coverage_mismatches;
      line["off_by_8"] = error.off_by_8;
      line["psnr"] = error.psnr;
    }
    result["rows"].push_back(line);
  }
  result["scaling"] = scaling;
  for (const Goal& goal : kGoals) {
    if (name == goal.scene && width == goal.width) {
      result["goal_ratio"] = goal.ratio;
      result["goal_scaling"] = goal.scaling;
    }
  }
  result["triangles"] = {{"in", counts.in},
                         {"outside", counts.outside},
                         {"back_facing", counts.back_facing},
                         {"no_sample", counts.no_sample},
                         {"drawn", counts.drawn},
                         {"hidden", counts.hidden}};
  result["samples"] = {{"tested", counts.samples_tested}, {"written", counts.samples_written}};
  return result;
}

void print(const nlohmann::json& result) {
  fmt::print(
      "{} {} x {}: {} triangles = {} outside + {} back-facing + {} without a sample + {} drawn (of these {} "
      "hidden); "
      "{} samples tested, {} written\n",
      result["scene"].get<std::string>(), result["width"].get<int>(), result["height"].get<int>(),
      result["triangles"]["in"].get<std::uint64_t>(), result["triangles"]["outside"].get<std::uint64_t>(),
      result["triangles"]["back_facing"].get<std::uint64_t>(),
      result["triangles"]["no_sample"].get<std::uint64_t>(),
      result["triangles"]["drawn"].get<std::uint64_t>(), result["triangles"]["hidden"].get<std::uint64_t>(),
      result["samples"]["tested"].get<std::uint64_t>(), result["samples"]["written"].get<std::uint64_t>());
  for (const nlohmann::json& line : result["rows"]) {
    fmt::print("  {:<20} {:9.3f} ms  (least {:9.3f}; to prepare {:7.1f})  {:6.2f} x llvmpipe",
               line["renderer"].get<std::string>(), line["ms"].get<double>(), line["min_ms"].get<double>(),
               line["preparation_ms"].get<double>(), line["ratio_to_llvmpipe"].get<double>());
    if (line.contains("psnr"))
      fmt::print("  {} coverage mismatches, {} pixels off by more than 8, {:.1f} dB",
                 line["coverage_mismatches"].get<std::uint64_t>(), line["off_by_8"].get<std::uint64_t>(),
                 line["psnr"].get<double>());
    fmt::print("\n");
  }
  fmt::print("  from 1 thread to {}: {:.2f} x", kThreads, result["scaling"].get<double>());
  if (result.contains("goal_ratio"))
    fmt::print("   (wanted: {} x llvmpipe, {} x from thread to threads)", result["goal_ratio"].get<double>(),
               result["goal_scaling"].get<double>());
  fmt::print("\n");
}

int run(int count, char** arguments) {
  Options options;
  for (int n = 1; n < count; ++n) {
    const std::string argument = arguments[n];
    const auto value = [&] { return n + 1 < count ? std::string(arguments[++n]) : std::string(); };
    if (argument == "--rounds") {
      options.rounds = std::max(1, std::atoi(value().c_str()));
    } else if (argument == "--scene") {
      options.scenes.push_back(value());
    } else if (argument == "--size") {
      options.size = std::atoi(value().c_str());
    } else if (argument == "--json") {
      options.json = true;
    } else if (argument == "--smoke") {
      options.smoke = true;
    } else if (argument == "--simd") {
      const std::string name = value();
      const std::optional<SimdTarget> target = simdTargetNamed(name);
      if (!target || !limitSimdTarget(target)) {
        fmt::print(stderr, "bench_core: error: this processor has no '{}'\n", name);
        return 2;
      }
    } else {
      fmt::print(stderr, "bench_core: error: unknown option '{}'\n", argument);
      return 2;
    }
  }
  // Read by Mesa when it starts.
  setenv("LP_NUM_THREADS", std::to_string(kThreads).c_str(), 1);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, kThreads);
  if (options.scenes.empty()) options.scenes = {"A", "B", "C-small-8", "C-large-8"};
  if (options.smoke) {
    options.scenes = {"B", "C-large-8"};
    options.rounds = 1;
    options.size = 512;
  }
  nlohmann::json all = nlohmann::json::array();
  for (const int size : {512, 1080}) {
    if (options.size != 0 && options.size != size) continue;
    for (const std::string& scene : options.scenes) {
      all.push_back(benchScene(scene, size == 512 ? 512 : 1920, size, options, size == 512 || options.smoke));
      if (!options.json) print(all.back());
    }
  }
  if (options.json) fmt::print("{}\n", all.dump(2));
  return 0;
}

}  // namespace
}  // namespace deltaz::bench

int main(int count, char** arguments) {
  return deltaz::bench::run(count, arguments);
}
