#include "librender/ars/experiments/memory_tables.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <deque>
#include <fmt/format.h>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/machine/machine.h"
#include "librender/ars/tiler/triangle_encoder.h"

namespace deltaz::ars {

namespace {

constexpr int kOctaves = 3;
// Square and limit of areas for 121.5 pixels oversampled, as in Table 23.
constexpr TrianglePopulation kPopulation = {.side = 68.7, .largest_area = 0.0383};
constexpr double kCentralSigma = 55;
constexpr int kTrianglesATiler = 500;  // Table 22

constexpr const char* kDepthsUnknown =
    "the report does not say what depths it drew; ours lie in three octaves";
constexpr const char* kCurveLost = "the curve is lost";
constexpr const char* kSixteen =
    "\"about sixteen\"; the report does not print how far its bursts scatter nor how fast its memories were: "
    "two "
    "memories to each side and five million pixels a second give it";

// The sum of twelve uniform numbers: near enough, and the same bits everywhere.
double gaussian(RandomNumbers& random) {
  double sum = -6;
  for (int k = 0; k < 12; ++k) sum += random.uniform(0, 1);
  return sum;
}

// Moved along i so that its box is centred there, as far as the picture allows.
void centre(ProjectedTriangle& triangle, double line) {
  const auto [least, most] = std::minmax({triangle[0].i, triangle[1].i, triangle[2].i});
  const double wanted = line - (least + most) / 2;
  const double shift = std::clamp(wanted, -least, kScreenLines - 1 - most);
  for (ProjectedVertex& vertex : triangle) vertex.i += shift;
}

constexpr CycleCounts kTable20Counts = {0, 156'964, 31'765, 25'499, 15'265, 14'114, 0};
constexpr std::int64_t kTable20Cycles = 243'607;

double percent(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

// Lower case, with underscores.
std::string idOf(std::string_view name) {
  std::string id(name);
  for (char& letter : id)
    if (letter == ' ' || letter == '-') letter = '_';
  return id;
}

// A configuration and load of our own making: an error would be a mistake here.
PassStatistics timed(const MachineConfiguration& configuration, const PixelSource& source) {
  Result<Machine> machine = Machine::make(configuration);
  assert(machine.ok());
  Result<PassStatistics> statistics = machine.value().runTimed(source);
  assert(statistics.ok());
  return statistics.ok() ? statistics.value() : PassStatistics{};
}

// A burst: a pixel a cycle and tiler, for memories scattered about the middle one, round the end.
constexpr int kBursts = 200, kBurstCycles = 100;
int burstMemory(int memories, double sigma, RandomNumbers& random) {
  const auto offset = static_cast<int>(std::lround(sigma * gaussian(random)));
  return ((memories / 2 + offset) % memories + memories) % memories;
}
// Of the memories at the worst that was expected, five million pixels a second (4.3.3.1). With the 6.67
// million of the average the queues are half as long as the report says.
constexpr Picoseconds kExpectedCycle = 200 * kNanosecond;

// The queueing model of a tree: a queue at every output of a 2 x 2 cell takes what comes from both inputs and
// gives a pixel a cycle, those before the memories one when the memory is free.
class QueueingModel {
 public:
  QueueingModel(int tilers, int memories)
      : shape_(treeShape(tilers, memories)), free_at_(static_cast<std::size_t>(memories)) {
    for (const TreeLevel& level : shape_.levels) {
      queues_.emplace_back(static_cast<std::size_t>(level.outputs()));
      sums_.emplace_back(static_cast<std::size_t>(level.outputs()));
    }
  }

  void run(std::int64_t cycle, double sigma, RandomNumbers& random) {
    drain(cycle);
    for (const int input : shape_.tiler_leads_to) take(0, input, burstMemory(shape_.memories, sigma, random));
    for (std::size_t l = 0; l < queues_.size(); ++l)
      for (std::size_t output = 0; output < queues_[l].size(); ++output)
        sums_[l][output] += static_cast<double>(queues_[l][output].size());
  }
  // A cycle in which no tiler sends.
  void drain(std::int64_t cycle) {
    for (std::size_t l = shape_.levels.size(); l-- > 0;) give(l, cycle);
  }
  bool empty() const {
    return std::all_of(queues_.begin(), queues_.end(), [](const auto& level) {
      return std::all_of(level.begin(), level.end(), [](const auto& queue) { return queue.empty(); });
    });
  }
  double longestAverage(std::size_t level, int cycles) const {
    return *std::max_element(sums_[level].begin(), sums_[level].end()) / cycles;
  }
  const TreeShape& shape() const { return shape_; }

 private:
  void take(std::size_t l, int input, int memory) {
    const TreeLevel& level = shape_.levels[l];
    const bool split = level.kind == CellKind::kSplit;
    const int bit = memory >> level.routing_shift & 1;
    const int cell = split ? input : input / 2;
    const std::size_t output = 2 * static_cast<std::size_t>(cell) + static_cast<std::size_t>(bit);
    if (split) {
      take(l + 1, level.leads_to[output], memory);
    } else {
      queues_[l][output].push_back(memory);
    }
  }
  void give(std::size_t l, std::int64_t cycle) {
    const TreeLevel& level = shape_.levels[l];
    for (std::size_t output = 0; output < queues_[l].size(); ++output) {
      std::deque<int>& queue = queues_[l][output];
      if (queue.empty()) continue;
      if (l + 1 == shape_.levels.size()) {
        Picoseconds& free_at = free_at_[output];
        if (free_at > cycle * kTreeCycle) continue;
        free_at = cycle * kTreeCycle + kExpectedCycle;
      } else {
        take(l + 1, level.leads_to[output], queue.front());
      }
      queue.pop_front();
    }
  }

  TreeShape shape_;
  std::vector<std::vector<std::deque<int>>> queues_;  // by level and output: memories
  std::vector<std::vector<double>> sums_;             // of lengths over cycles
  std::vector<Picoseconds> free_at_;                  // by memory
};

// The longest average queue of each level, averaged over bursts.
std::vector<double> modelQueues(int tilers, int memories, double sigma) {
  RandomNumbers random(29);
  std::vector<double> longest;
  for (int burst = 0; burst < kBursts; ++burst) {
    QueueingModel model(tilers, memories);
    for (std::int64_t cycle = 0; cycle < kBurstCycles; ++cycle) model.run(cycle, sigma, random);
    longest.resize(model.shape().levels.size());
    for (std::size_t l = 0; l < longest.size(); ++l)
      longest[l] += model.longestAverage(l, kBurstCycles) / kBursts;
  }
  return longest;
}

// Tilers that work, on the average of a burst and of clearing what it left in the queues.
double effectiveTilers(int tilers, double cycles) {
  return tilers * kBurstCycles * kBursts / cycles;
}

double modelEffectiveTilers(int tilers, int memories, double sigma) {
  RandomNumbers random(30);
  double cycles = 0;
  for (int burst = 0; burst < kBursts; ++burst) {
    QueueingModel model(tilers, memories);
    std::int64_t cycle = 0;
    for (; cycle < kBurstCycles; ++cycle) model.run(cycle, sigma, random);
    for (; !model.empty(); ++cycle) model.drain(cycle);
    cycles += static_cast<double>(cycle);
  }
  return effectiveTilers(tilers, cycles);
}

// A burst of so many pixels a tiler.
class BurstInlets final : public TreeInlets {
 public:
  BurstInlets(int tilers, int memories, double sigma, RandomNumbers& random)
      : next_(static_cast<std::size_t>(tilers)),
        sent_(static_cast<std::size_t>(tilers)),
        memories_(memories),
        sigma_(sigma),
        random_(random) {}

  std::int64_t readyCycle(int tiler) override {
    const auto t = static_cast<std::size_t>(tiler);
    return sent_[t] < kBurstCycles ? next_[t] : kNoCycle;
  }
  TreePixel take(int tiler, std::int64_t cycle) override {
    next_[static_cast<std::size_t>(tiler)] = cycle + 1;
    ++sent_[static_cast<std::size_t>(tiler)];
    TreePixel pixel;
    pixel.memory = static_cast<std::uint8_t>(burstMemory(memories_, sigma_, random_));
    pixel.tiler = static_cast<std::uint8_t>(tiler);
    pixel.sequence = static_cast<std::uint32_t>(cycle) + 1;
    return pixel;
  }

 private:
  std::vector<std::int64_t> next_;
  std::vector<int> sent_;  // by tiler
  int memories_;
  double sigma_;
  RandomNumbers& random_;
};

// Memories with no FIFO before them.
class BareMemories final : public TreeOutlets {
 public:
  explicit BareMemories(int memories) : free_at_(static_cast<std::size_t>(memories)) {}

  bool offer(int memory, const TreePixel&, std::int64_t cycle) override {
    Picoseconds& free_at = free_at_[static_cast<std::size_t>(memory)];
    if (free_at > cycle * kTreeCycle) return false;
    free_at = cycle * kTreeCycle + kExpectedCycle;
    return true;
  }

 private:
  std::vector<Picoseconds> free_at_;
};

// The same of the tree as built.
std::vector<double> treeQueues(int tilers, int memories, double sigma) {
  RandomNumbers random(29);
  std::vector<double> longest;
  for (int burst = 0; burst < kBursts; ++burst) {
    BurstInlets inlets(tilers, memories, sigma, random);
    BareMemories outlets(memories);
    DistributionTree tree(tilers, memories, inlets, outlets);
    for (std::int64_t cycle = 0; cycle < kBurstCycles; ++cycle) tree.run(cycle);
    const TreeStatistics statistics = tree.statistics(kBurstCycles);
    longest.resize(statistics.levels.size());
    for (std::size_t l = 0; l < statistics.levels.size(); ++l) {
      double most = 0;
      for (const QueueStatistics& queue : statistics.levels[l].queues) {
        std::int64_t sum = 0;
        for (std::size_t length = 0; length < queue.cycles_at_length.size(); ++length)
          sum += static_cast<std::int64_t>(length) * queue.cycles_at_length[length];
        most = std::max(most, static_cast<double>(sum) / kBurstCycles);
      }
      longest[l] += most / kBursts;
    }
  }
  return longest;
}

double treeEffectiveTilers(int tilers, int memories, double sigma) {
  RandomNumbers random(30);
  double cycles = 0;
  for (int burst = 0; burst < kBursts; ++burst) {
    BurstInlets inlets(tilers, memories, sigma, random);
    BareMemories outlets(memories);
    DistributionTree tree(tilers, memories, inlets, outlets);
    std::int64_t run = 0;
    for (std::int64_t cycle = tree.nextCycle(0); cycle != TreeInlets::kNoCycle; cycle = tree.nextCycle(run)) {
      tree.run(cycle);
      run = cycle + 1;
    }
    cycles += static_cast<double>(run);
  }
  return effectiveTilers(tilers, cycles);
}

}  // namespace

TriangleSource memoryLoad(const MemoryLoad& load) {
  TriangleSource source({});
  source.reserve(static_cast<std::size_t>(load.triangles));
  RandomNumbers random(load.seed);
  for (int k = 0; k < load.triangles; ++k) {
    ProjectedTriangle triangle = randomTriangle(random, kPopulation);
    if (load.line_sigma > 0) centre(triangle, (kScreenLines - 1) / 2.0 + load.line_sigma * gaussian(random));
    // Only the order within an octave counts, so any distribution in it will do.
    const double depth = random.uniform(0.5, 1) / static_cast<double>(1 << random.below(kOctaves));
    for (ProjectedVertex& vertex : triangle) vertex.depth = depth;
    const EncodedTriangle encoded =
        encodeTriangle(triangle, source.configuration().numbers, {.oversample = true, .background = false});
    source.add(encoded.variables);
  }
  return source;
}

std::vector<ReportRow> table19Rows() {
  // Measured on the machine; BG, INIT, LANW, LAW, RCNW, RCW, READ.
  constexpr std::array<double, kMemoryCycleCount> kPublished = {115, 165, 150, 190, 170, 210, 240};
  const CycleLengths lengths = cycleLengths(MemoryDesign::kVariable);
  std::vector<ReportRow> rows;
  for (std::size_t k = 0; k < kMemoryCycleCount; ++k) {
    const std::string_view name = memoryCycleName(static_cast<MemoryCycle>(k));
    rows.push_back({.id = "table19." + idOf(name),
                    .description = fmt::format("{} cycle, ns", name),
                    .published = kPublished[k],
                    .ours = static_cast<double>(lengths.nanoseconds[k]),
                    .note = "taken from the report"});
  }
  return rows;
}

std::vector<ReportRow> table20Rows() {
  constexpr double kPixels = std::int64_t{kScreenLines} * kScreenPixels;
  MachineConfiguration configuration;
  configuration.buffer_triangles = kTrianglesATiler;
  const PassStatistics statistics = timed(configuration, memoryLoad({}));
  const MemoryCounts counts = statistics.memoryCounts();
  const std::int64_t cycles = counts.writes();
  std::vector<ReportRow> rows;
  const auto add = [&rows](const char* id, const char* description, std::optional<double> published,
                           double ours, const char* note) {
    rows.push_back({.id = fmt::format("table20.{}", id),
                    .description = description,
                    .published = published,
                    .ours = ours,
                    .note = note});
  };
  add("cycles", "memory cycles of 2,000 triangles", kTable20Cycles, static_cast<double>(cycles),
      "the report's triangles are one draw; Table 22 counts 243,606 pixels of the same frame");
  add("depth_complexity", "cycles a pixel of the picture", 0.929, static_cast<double>(cycles) / kPixels, "");
  for (std::size_t k = 0; k < kWriteCycleCount; ++k) {
    const std::string_view name = memoryCycleName(static_cast<MemoryCycle>(k));
    rows.push_back({.id = fmt::format("table20.{}_percent", idOf(name)),
                    .description = fmt::format("{} cycles, per cent", name),
                    .published = percent(kTable20Counts[k], kTable20Cycles),
                    .ours = percent(counts.cycles[k], cycles),
                    .note = kDepthsUnknown});
  }
  const auto [fewest, most] =
      std::minmax_element(statistics.memories.begin(), statistics.memories.end(),
                          [](const auto& a, const auto& b) { return a.counts.writes() < b.counts.writes(); });
  add("unevenness", "most accesses of a memory over fewest, scramble", 30'620.0 / 30'377,
      static_cast<double>(most->counts.writes()) / static_cast<double>(fewest->counts.writes()), "");
  const CycleLengths lengths = cycleLengths(MemoryDesign::kVariable);
  const double theirs = averageCycle(kTable20Counts, lengths);
  add("average_cycle", "average cycle, ns", theirs, averageCycle(counts.cycles, lengths),
      "published: from the report's counts and Table 19");
  add("average_cycle_of_published_counts", "average cycle of the report's counts, ns", std::nullopt, theirs,
      "");
  add("saving", "saved over one length of 210 ns, per cent, from the report's counts", 20,
      100 * (1 - theirs / 210), "the report rounds");
  add("rate", "million pixels a second of eight memories, from the report's counts", std::nullopt,
      8 * 1000 / theirs, "\"greater than 40\": all read-compare writes would give 38.1");
  return rows;
}

std::vector<ReportRow> figure29Rows() {
  struct Network {
    int tilers, memories;
  };
  std::vector<ReportRow> rows;
  for (const auto& [tilers, memories] : {Network{2, 4}, Network{4, 8}, Network{8, 16}, Network{16, 32}}) {
    for (const double sigma : {1.0, 2.0, 3.0}) {
      const std::vector<double> model = modelQueues(tilers, memories, sigma),
                                tree = treeQueues(tilers, memories, sigma);
      for (std::size_t l = 1; l < model.size(); ++l) {
        const std::string where = fmt::format("{}x{}.sigma_{:.0f}.level_{}", tilers, memories, sigma, l);
        const std::string what = fmt::format(
            "{} x {} tree, bursts over {:.0f} memories to each side: longest average queue of level {}, "
            "pixels",
            tilers, memories, sigma, l);
        const bool cited = tilers == 4 && sigma == 2 && l + 1 == model.size();
        rows.push_back({.id = "figure29.model." + where,
                        .description = what,
                        .published = cited ? std::optional<double>(16) : std::nullopt,
                        .ours = model[l],
                        .note = cited ? kSixteen : kCurveLost});
        rows.push_back(
            {.id = "figure29.tree." + where,
             .description = what,
             .published = std::nullopt,
             .ours = tree[l],
             .note = "of Table 10's cells, which queue nothing while their output is free and keep the "
                     "loser of a tie waiting above"});
      }
    }
  }
  return rows;
}

std::vector<ReportRow> figure30Rows() {
  std::vector<ReportRow> rows;
  for (const int tilers : {2, 4, 8, 16}) {
    const int memories = 2 * tilers;
    for (const double sigma : {1.0, 2.0, 3.0}) {
      const std::string where = fmt::format("sigma_{:.0f}.{}", sigma, tilers);
      const std::string what = fmt::format(
          "{} x {} tree, bursts of {} pixels a tiler over {:.0f} memories to each side: effective number of "
          "tilers",
          tilers, memories, kBurstCycles, sigma);
      rows.push_back({.id = "figure30.model." + where,
                      .description = what,
                      .published = std::nullopt,
                      .ours = modelEffectiveTilers(tilers, memories, sigma),
                      .note = kCurveLost});
      rows.push_back({.id = "figure30.tree." + where,
                      .description = what,
                      .published = std::nullopt,
                      .ours = treeEffectiveTilers(tilers, memories, sigma),
                      .note = "of Table 10's cells"});
    }
  }
  return rows;
}

std::vector<ReportRow> figure84And85Rows() {
  std::vector<ReportRow> rows;
  for (const int triangles : {500, 1000, 2000, 4000, 8000}) {
    const TriangleSource source = memoryLoad({.triangles = triangles});
    Machine machine = Machine::make({}).value();
    const MemoryCounts counts = machine.runFunctional(source);
    const double complexity = static_cast<double>(counts.writes()) / (kScreenLines * kScreenPixels);
    const std::string where = fmt::format("depth complexity {:.2f}", complexity);
    for (std::size_t k = 1; k < kWriteCycleCount; ++k) {
      const std::string_view name = memoryCycleName(static_cast<MemoryCycle>(k));
      rows.push_back({.id = fmt::format("figure84.{}.{}_percent", triangles, idOf(name)),
                      .description = fmt::format("{}: {} cycles, per cent", where, name),
                      .published = std::nullopt,
                      .ours = percent(counts.cycles[k], counts.writes()),
                      .note = kCurveLost});
    }
    for (const MemoryDesign design : kMemoryDesigns) {
      rows.push_back(
          {.id = fmt::format("figure85.{}.{}", triangles, idOf(memoryDesignName(design))),
           .description = fmt::format("{}: average cycle of design {}, ns", where, memoryDesignName(design)),
           .published = std::nullopt,
           .ours = averageCycle(counts.cycles, cycleLengths(design)),
           .note = kCurveLost});
    }
  }
  for (const MemoryDesign design : kMemoryDesigns) {
    rows.push_back({.id = fmt::format("figure85.table20.{}", idOf(memoryDesignName(design))),
                    .description = fmt::format("counts of Table 20: average cycle of design {}, ns",
                                               memoryDesignName(design)),
                    .published = std::nullopt,
                    .ours = averageCycle(kTable20Counts, cycleLengths(design)),
                    .note = kCurveLost});
  }
  return rows;
}

std::vector<ReportRow> figure91And92Rows() {
  const TriangleSource source = memoryLoad({.line_sigma = kCentralSigma});
  std::vector<ReportRow> rows;
  for (const HashingMode mode :
       {HashingMode::kSequential, HashingMode::kInterleave, HashingMode::kScramble}) {
    const std::string name(hashingModeName(mode));
    for (const int clock : {25, 50, 75, 100}) {
      MachineConfiguration configuration;
      configuration.mode = mode;
      configuration.tiler_clock_percent = clock;
      configuration.buffer_triangles = kTrianglesATiler;
      const PassStatistics statistics = timed(configuration, source);
      ReportRow row{.id = fmt::format("figure91.{}.{}", name, clock),
                    .description = fmt::format("{}, tilers at {} %: longest queue, pixels", name, clock),
                    .published = std::nullopt,
                    .ours = static_cast<double>(statistics.tree.longestQueue()),
                    .note = kCurveLost};
      if (mode == HashingMode::kSequential && clock == 100) {
        row.published = kQueueDepth;
        row.note = "\"approaching the system maximum of 256\"";
      } else if (mode == HashingMode::kInterleave && clock == 100) {
        row.note =
            "\"reasonably low and constant at all speeds\" does not reproduce: it grows with the clock";
      } else if (mode == HashingMode::kScramble && clock == 100) {
        row.note = "\"almost non-existent\"";
      }
      rows.push_back(row);
      if (clock != 100) continue;

      rows.push_back(
          {.id = fmt::format("throughput.{}", name),
           .description = fmt::format("{}: million pixels a second", name),
           .published = mode == HashingMode::kSequential ? std::nullopt : std::optional<double>(40),
           .ours = 10 * statistics.pixelsPerTreeCycle(),
           .note = mode == HashingMode::kSequential
                       ? ""
                       : "40 needs every sample to be a pixel; of these triangles' samples 72 % are"});
      rows.push_back(
          {.id = fmt::format("overtaken.{}", name),
           .description = fmt::format("{}: pixels overtaken by later ones of their tiler, per cent", name),
           .published = std::nullopt,
           .ours = percent(statistics.tree.overtaken, statistics.tree.left),
           .note = "the report does not say that Table 10 reorders"});
      for (std::size_t m = 0; m < statistics.memories.size(); ++m) {
        rows.push_back({.id = fmt::format("figure92.{}.memory_{}", name, m),
                        .description = fmt::format("{}: accesses of memory {}", name, m),
                        .published = std::nullopt,
                        .ours = static_cast<double>(statistics.memories[m].counts.writes()),
                        .note = kCurveLost});
      }
    }
  }
  return rows;
}

std::vector<ReportRow> table25Rows() {
  // 21,000 of terrain, 3,600 of models, depth complexity 1.74; small ones all over the picture instead.
  constexpr int kTriangles = 24'600;
  constexpr double kComplexity = 1.74;
  std::vector<ReportRow> rows;
  for (const bool oversample : {false, true}) {
    TriangleSource source({});
    source.reserve(kTriangles);
    RandomNumbers random(25);
    for (int k = 0; k < kTriangles; ++k) {
      const ProjectedTriangle triangle = randomTriangle(random, {.side = oversample ? 11.32 : 15.36});
      source.add(encodeTriangle(triangle, source.configuration().numbers,
                                {.oversample = oversample, .background = false})
                     .variables);
    }
    const PassStatistics statistics = timed({}, source);
    const std::string mode = oversample ? "oversample" : "undersample";
    const auto add = [&](const char* id, const char* description, std::optional<double> published,
                         double ours, const char* note) {
      rows.push_back({.id = fmt::format("table25.{}.{}", mode, id),
                      .description = fmt::format("24,600 triangles, {}: {}", mode, description),
                      .published = published,
                      .ours = ours,
                      .note = note});
    };
    add("depth_complexity", "pixels written for each of the picture", kComplexity,
        static_cast<double>(statistics.pixels()) / (kScreenLines * kScreenPixels),
        "ours are as many and as large");
    add("frame", "one colour, ms", std::nullopt, static_cast<double>(statistics.duration) / 1e9,
        "set-up takes all of it; a picture in colour takes three");
    Picoseconds busy = 0;
    for (const MemoryStatistics& memory : statistics.memories) busy = std::max(busy, memory.channel.busy);
    add("memory_busy", "the busiest memory, ms", std::nullopt, static_cast<double>(busy) / 1e9, "");
  }
  return rows;
}

std::vector<ReportRow> memoryReportRows() {
  std::vector<ReportRow> all;
  for (const auto& rows : {table19Rows(), table20Rows(), figure29Rows(), figure30Rows(), figure84And85Rows(),
                           figure91And92Rows(), table25Rows()})
    all.insert(all.end(), rows.begin(), rows.end());
  return all;
}

}  // namespace deltaz::ars
