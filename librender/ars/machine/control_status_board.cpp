#include "librender/ars/machine/control_status_board.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace deltaz::ars {

namespace {

using Json = nlohmann::ordered_json;

// The columns of Table 20 behind the number of cycles, in its order.
struct Column {
  MemoryCycle cycle;
  const char* heading;
  const char* key;
};
constexpr std::array<Column, kWriteCycleCount> kTable20 = {
    {{MemoryCycle::kInitialize, "INITIALIZE", "initialize"},
     {MemoryCycle::kBackground, "BACKGROUND", "background"},
     {MemoryCycle::kLookAheadWrite, "LOOK AHEAD", "look_ahead_write"},
     {MemoryCycle::kLookAheadNoWrite, "LOOK AHEAD NO", "look_ahead_no_write"},
     {MemoryCycle::kReadCompareWrite, "READ COMPARE", "read_compare_write"},
     {MemoryCycle::kReadCompareNoWrite, "READ COMPARE NO", "read_compare_no_write"}}};

std::int64_t countOf(const MemoryCounts& counts, MemoryCycle cycle) {
  return counts.cycles[static_cast<std::size_t>(cycle)];
}

// 0 where there is nothing to divide by.
double ratio(std::int64_t part, std::int64_t whole) {
  return whole != 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

std::int64_t wordsOf(const PassStatistics& statistics) {
  return std::int64_t{kScreenLines} * kScreenPixels / static_cast<std::int64_t>(statistics.memories.size());
}

TilerStatistics totalOf(const std::vector<TilerStatistics>& tilers) {
  TilerStatistics sum;
  for (const TilerStatistics& tiler : tilers) {
    sum.triangles += tiler.triangles;
    sum.samples += tiler.samples;
    sum.pixels += tiler.pixels;
  }
  return sum;
}

std::string memoryTable(const PassStatistics& statistics) {
  std::string text = fmt::format("{:<8}{:>10}", "MEMORY", "CYCLES");
  for (const Column& column : kTable20) fmt::format_to(std::back_inserter(text), "{:>17}", column.heading);
  text += fmt::format("{:>12}\n{:<18}", "DEPTH", "NUMBER");
  for (std::size_t k = 0; k < kTable20.size(); ++k) text += fmt::format("{:>17}", "WRITE");
  text += fmt::format("{:>12}\n", "COMPLEXITY");
  const auto row = [&text](const std::string& name, const MemoryCounts& counts, std::int64_t words) {
    text += fmt::format("{:<8}{:>10}", name, counts.writes());
    for (const Column& column : kTable20) text += fmt::format("{:>17}", countOf(counts, column.cycle));
    text += fmt::format("{:>12.3f}\n", depthComplexity(counts.writes(), words));
  };
  const std::int64_t words = wordsOf(statistics);
  for (std::size_t m = 0; m < statistics.memories.size(); ++m)
    row(fmt::format("{}", m), statistics.memories[m].counts, words);
  const auto memories = static_cast<std::int64_t>(statistics.memories.size());
  row("TOTAL", statistics.memoryCounts(), words * memories);
  return text;
}

std::string tilerTable(const PassStatistics& statistics) {
  std::string text = fmt::format("{:<8}{:>12}{:>12}{:>12}{:>24}{:>28}\n", "TILER", "TRIANGLES", "PIXELS",
                                 "PIXELS", "AVERAGE TRIANGLE", "AVERAGE SAMPLING");
  text += fmt::format("{:<8}{:>12}{:>12}{:>12}{:>24}{:>28}\n", "NUMBER", "TILED", "SAMPLED", "TILED",
                      "SIZE IN PIXELS", "EFFICIENCY (%)");
  const auto row = [&text](const std::string& name, const TilerStatistics& tiler) {
    text += fmt::format("{:<8}{:>12}{:>12}{:>12}{:>24.3f}{:>28.3f}\n", name, tiler.triangles, tiler.samples,
                        tiler.pixels, ratio(tiler.pixels, tiler.triangles),
                        100 * ratio(tiler.pixels, tiler.samples));
  };
  // The report counts tilers from 1, memories from 0.
  for (std::size_t t = 0; t < statistics.tilers.size(); ++t)
    row(fmt::format("{}", t + 1), statistics.tilers[t]);
  row("TOTAL", totalOf(statistics.tilers));
  return text;
}

std::string timeTable(const PassStatistics& statistics) {
  std::string text = fmt::format("{:<22}{:>9}{:>9}{:>9}{:>9}\n", "TIME, % OF THE FRAME", "BUSY", "STARVED",
                                 "BLOCKED", "LOST");
  const auto row = [&text](const std::string& name, std::int64_t whole, std::int64_t busy,
                           std::int64_t starved, std::int64_t blocked, std::int64_t lost) {
    text += fmt::format("{:<22}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}\n", name, 100 * ratio(busy, whole),
                        100 * ratio(starved, whole), 100 * ratio(blocked, whole), 100 * ratio(lost, whole));
  };
  for (std::size_t t = 0; t < statistics.tilers.size(); ++t) {
    const TilerStatistics& tiler = statistics.tilers[t];
    for (const auto& [unit, times] : {std::pair{"transfer", &tiler.transfer},
                                      std::pair{"set-up", &tiler.set_up}, std::pair{"tiling", &tiler.tiling}})
      row(fmt::format("tiler {} {}", t + 1, unit), statistics.duration, times->busy, times->starved,
          times->blocked, 0);
  }
  const auto level = [&](const std::string& name, const std::vector<RegisterStatistics>& registers) {
    RegisterStatistics sum;
    for (const RegisterStatistics& one : registers) {
      sum.busy += one.busy;
      sum.starved += one.starved;
      sum.blocked += one.blocked;
      sum.lost += one.lost;
    }
    row(name, sum.sum(), sum.busy, sum.starved, sum.blocked, sum.lost);
  };
  for (std::size_t l = 0; l < statistics.tree.levels.size(); ++l)
    level(fmt::format("tree level {} inputs", l + 1), statistics.tree.levels[l].inputs);
  level("tree outlets", statistics.tree.outlets);
  for (std::size_t m = 0; m < statistics.memories.size(); ++m) {
    const MemoryChannelStatistics& memory = statistics.memories[m].channel;
    row(fmt::format("memory {}", m), statistics.duration, memory.busy, memory.starved, 0, 0);
  }
  return text;
}

std::string queueLines(const PassStatistics& statistics) {
  std::string text;
  for (std::size_t l = 0; l < statistics.tree.levels.size(); ++l) {
    const TreeLevelStatistics& level = statistics.tree.levels[l];
    if (level.queues.empty()) continue;
    text += fmt::format("LONGEST QUEUES OF TREE LEVEL {} =", l + 1);
    for (const QueueStatistics& queue : level.queues) text += fmt::format(" {}", queue.high_water);
    text += '\n';
  }
  text += "LONGEST QUEUES BEFORE THE MEMORIES =";
  for (const MemoryStatistics& memory : statistics.memories)
    text += fmt::format(" {}", memory.channel.high_water);
  text += "\nLONGEST QUEUES BEHIND THE TILERS =";
  for (const TilerStatistics& tiler : statistics.tilers) text += fmt::format(" {}", tiler.output_high_water);
  return text + '\n';
}

Json jsonOf(const RegisterStatistics& one) {
  return {{"busy", one.busy}, {"starved", one.starved}, {"blocked", one.blocked}, {"lost", one.lost}};
}

Json jsonOf(const std::vector<RegisterStatistics>& registers) {
  Json list = Json::array();
  for (const RegisterStatistics& one : registers) list.push_back(jsonOf(one));
  return list;
}

Json jsonOf(const UnitTimes& times) {
  return {{"busy_ps", times.busy}, {"starved_ps", times.starved}, {"blocked_ps", times.blocked}};
}

Json jsonOf(const MemoryCounts& counts, std::int64_t words, const CycleLengths& lengths) {
  Json row = {{"cycles", counts.writes()}};
  for (const Column& column : kTable20) row[column.key] = countOf(counts, column.cycle);
  row["depth_complexity"] = ratio(counts.writes(), words);
  row["average_cycle_ns"] = averageCycle(counts.cycles, lengths);
  row["ties"] = counts.ties;
  row["split_ties"] = counts.split_ties;
  return row;
}

Json tilerRow(const TilerStatistics& tiler) {
  return {{"triangles_tiled", tiler.triangles},
          {"pixels_sampled", tiler.samples},
          {"pixels_tiled", tiler.pixels},
          {"average_triangle_size", ratio(tiler.pixels, tiler.triangles)},
          {"sampling_efficiency_percent", 100 * ratio(tiler.pixels, tiler.samples)}};
}

Json jsonOf(const TreeStatistics& tree) {
  Json levels = Json::array();
  for (const TreeLevelStatistics& level : tree.levels) {
    constexpr std::array kKinds = {"split", "switch", "merge"};
    Json queues = Json::array();
    for (const QueueStatistics& queue : level.queues)
      queues.push_back({{"direct", queue.direct},
                        {"queued", queue.queued},
                        {"high_water", queue.high_water},
                        {"cycles_at_length", queue.cycles_at_length}});
    Json row = {{"cells", kKinds[static_cast<std::size_t>(level.kind)]}, {"inputs", jsonOf(level.inputs)}};
    if (!level.buffers.empty()) row["buffers"] = jsonOf(level.buffers);
    if (!queues.empty()) row["queues"] = queues;
    levels.push_back(row);
  }
  return {{"cycles", tree.cycles},
          {"pixels", tree.left},
          {"overtaken", tree.overtaken},
          {"longest_queue", tree.longestQueue()},
          {"levels", levels},
          {"outlets", jsonOf(tree.outlets)}};
}

Json jsonOf(const MachineConfiguration& configuration) {
  return {{"tilers", configuration.tilers},
          {"memories", configuration.memories},
          {"unavailable", configuration.unavailable},
          {"mode", hashingModeName(configuration.mode)},
          {"discipline", queueDisciplineName(configuration.discipline)},
          {"queue_depth", configuration.queue_depth},
          {"memory_design", memoryDesignName(configuration.memory_design)},
          {"ties", tieRuleName(configuration.ties)},
          {"depth_mantissa_bits", configuration.depth_mantissa_bits},
          {"memory_fifo", configuration.memory_fifo},
          {"tiler_clock_percent", configuration.tiler_clock_percent},
          {"transfer_fifo", configuration.transfer_fifo},
          {"set_up_fifo", configuration.set_up_fifo},
          {"output_fifo", configuration.output_fifo},
          {"buffers", configuration.buffers},
          {"buffer_triangles", configuration.buffer_triangles},
          {"word_transfer_ns", configuration.word_transfer},
          {"host_triangle_ns", configuration.host_triangle},
          {"barriers", configuration.barriers}};
}

}  // namespace

double depthComplexity(std::int64_t cycles, std::int64_t words) {
  const std::int64_t thousandths = words > 0 ? 1000 * cycles / words : 0;
  return static_cast<double>(thousandths) / 1000;
}

std::string statisticsText(const PassStatistics& statistics, const MachineConfiguration& configuration) {
  const MemoryCounts counts = statistics.memoryCounts();
  const TilerStatistics tiled = totalOf(statistics.tilers);
  std::string mode(hashingModeName(configuration.mode));
  std::transform(mode.begin(), mode.end(), mode.begin(), [](char letter) {
    return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 32) : letter;
  });
  std::string text = memoryTable(statistics);
  text += fmt::format(
      "TOTAL MEMORY CYCLES = {}\nSYSTEM DEPTH COMPLEXITY = {:.3f}\nTRIANGLES TILED = {}\n"
      "AVERAGE TRIANGLE SIZE = {:.0f} PIXELS\nDISTRIBUTION TREE MODE = {}\nAVERAGE MEMORY CYCLE = {:.2f} "
      "NS\n\n",
      counts.writes(), depthComplexity(counts.writes(), std::int64_t{kScreenLines} * kScreenPixels),
      tiled.triangles, ratio(tiled.pixels, tiled.triangles), mode,
      averageCycle(counts.cycles, cycleLengths(configuration.memory_design)));
  text += tilerTable(statistics) + '\n' + timeTable(statistics) + '\n' + queueLines(statistics);
  text += fmt::format("PIXELS OVERTAKEN = {} ({:.3f} %)\nTIES = {}, OF ANOTHER COLOUR {}\n",
                      statistics.tree.overtaken, 100 * ratio(statistics.tree.overtaken, statistics.tree.left),
                      counts.ties, counts.split_ties);
  text += fmt::format("FRAME = {:.3f} MS, {:.2f} PIXELS IN 100 NS; READING = {:.3f} MS\n",
                      static_cast<double>(statistics.duration) / 1e9, statistics.pixelsPerTreeCycle(),
                      static_cast<double>(statistics.reading) / 1e9);
  return text;
}

std::string statisticsJson(const PassStatistics& statistics, const MachineConfiguration& configuration) {
  const CycleLengths lengths = cycleLengths(configuration.memory_design);
  const std::int64_t words = wordsOf(statistics);
  Json memories = Json::array(), tilers = Json::array();
  for (const MemoryStatistics& memory : statistics.memories) {
    Json row = jsonOf(memory.counts, words, lengths);
    row["busy_ps"] = memory.channel.busy;
    row["starved_ps"] = memory.channel.starved;
    row["fifo_high_water"] = memory.channel.high_water;
    row["found_in_fifo"] = memory.channel.found;
    memories.push_back(row);
  }
  for (const TilerStatistics& tiler : statistics.tilers) {
    Json row = tilerRow(tiler);
    row["transfer"] = jsonOf(tiler.transfer);
    row["set_up"] = jsonOf(tiler.set_up);
    row["tiling"] = jsonOf(tiler.tiling);
    row["loading_ps"] = tiler.loading;
    row["output_high_water"] = tiler.output_high_water;
    tilers.push_back(row);
  }
  const Json json = {{"configuration", jsonOf(configuration)},
                     {"duration_ps", statistics.duration},
                     {"reading_ps", statistics.reading},
                     {"barriers", statistics.barriers},
                     {"pixels", statistics.pixels()},
                     {"pixels_per_cycle", statistics.pixelsPerTreeCycle()},
                     {"memories", memories},
                     {"memory_totals", jsonOf(statistics.memoryCounts(),
                                              words * static_cast<std::int64_t>(memories.size()), lengths)},
                     {"tilers", tilers},
                     {"tiler_totals", tilerRow(totalOf(statistics.tilers))},
                     {"tree", jsonOf(statistics.tree)}};
  return json.dump(2) + '\n';
}

}  // namespace deltaz::ars
