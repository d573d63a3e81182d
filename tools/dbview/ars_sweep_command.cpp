#include "tools/dbview/ars_sweep_command.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <limits>
#include <optional>

#include "formats/file_system.h"
#include "librender/ars/engine/stream_player.h"
#include "librender/ars/machine/frame_limit.h"
#include "librender/scene/arena.h"
#include "tools/common/json_output.h"
#include "tools/common/line_svg.h"
#include "tools/common/output_file.h"
#include "tools/common/png_file.h"
#include "tools/common/progress.h"
#include "tools/dbview/report_paths.h"

namespace deltaz {

namespace {

constexpr std::size_t kMostValues = 64;

struct ArsSweepRow {
  std::string value;
  double frame_ms = 0, reading_ms = 0;  // simulated, all passes and sub-images
  double pixels_per_cycle = 0;          // of 100 ns
  int longest_queue = 0;
  double memory_cycle_ns = 0;       // mean of write cycles
  double lost_percent = 0;          // of the tree's registers' time, in arbitration
  double blocked_percent = 0;       // of the tilers' time
  double peak_signal_to_noise = 0;  // dB, against the judge
  int triangle_bits = 0, pixel_bits = 0;
  std::uint64_t pixels = 0;
  ars::StageTimes stages;  // of all runs
};

std::vector<std::string> valuesOf(const std::string& text) {
  std::vector<std::string> values(1);
  for (const char c : text) {
    if (c == ',') {
      values.emplace_back();
    } else {
      values.back().push_back(c);
    }
  }
  return values;
}

// What pictures are held against: one of as many colours as the stream has passes.
using Colors = std::vector<std::vector<std::uint8_t>>;

// The same of a picture file, which a stream of one pass, brightness alone, cannot be held against.
Result<Colors> colorsOf(const std::string& path, const ars::TriangleStream& stream) {
  DELTAZ_TRY_ASSIGN(const PictureColors picture, readPng(path));
  if (picture.width != stream.picture_width || picture.height != stream.picture_height) {
    return usageError(path,
                      fmt::format("it has {} x {} pixels, the stream's picture {} x {}", picture.width,
                                  picture.height, stream.picture_width, stream.picture_height),
                      {}, "Draw the same view with --engine reference, as large as the stream's samples");
  }
  if (stream.passes != ars::kColors)
    return usageError("--against", "the stream is of brightness alone", {}, "Record one in colour");
  Colors colors(ars::kColors);
  for (std::size_t k = 0; k < picture.rgb.size(); ++k) colors[k % ars::kColors].push_back(picture.rgb[k]);
  return colors;
}

double decibels(const Colors& picture, const Colors& judge) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t pass = 0; pass < picture.size(); ++pass) {
    for (std::size_t k = 0; k < picture[pass].size(); ++k) {
      const double difference = static_cast<double>(picture[pass][k]) - judge[pass][k];
      sum += difference * difference;
    }
    count += picture[pass].size();
  }
  return sum > 0 ? 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / sum)
                 : std::numeric_limits<double>::infinity();
}

ArsSweepRow rowOf(const std::string& value, const ArsOptions& options, const ars::PlayedStream& played,
                  const Colors& judge) {
  ArsSweepRow row;
  row.value = value;
  row.frame_ms = static_cast<double>(played.drawing) / static_cast<double>(ars::kMillisecond);
  row.reading_ms = static_cast<double>(played.reading) / static_cast<double>(ars::kMillisecond);
  row.peak_signal_to_noise = decibels(played.color, judge);
  row.triangle_bits = ars::triangleBits(options.tiler.numbers);
  row.pixel_bits = ars::pixelBits(options.tiler.numbers);
  ars::CycleCounts cycles{};
  double lost = 0, tree_time = 0, blocked = 0, tiler_time = 0;
  for (const ars::FrameRun& run : played.runs) {
    row.stages += ars::stageTimes(run.statistics, options.machine);
    row.longest_queue = std::max(row.longest_queue, run.statistics.tree.longestQueue());
    row.pixels += static_cast<std::uint64_t>(run.statistics.pixels());
    for (std::size_t k = 0; k < cycles.size(); ++k) cycles[k] += run.memory.cycles[k];
    for (const ars::TreeLevelStatistics& level : run.statistics.tree.levels) {
      for (const ars::RegisterStatistics& input : level.inputs) {
        lost += static_cast<double>(input.lost);
        tree_time += static_cast<double>(input.busy + input.starved + input.blocked + input.lost);
      }
    }
    for (const ars::TilerStatistics& tiler : run.statistics.tilers) {
      blocked += static_cast<double>(tiler.tiling.blocked);
      tiler_time += static_cast<double>(tiler.tiling.sum());
    }
  }
  if (played.drawing > 0)
    row.pixels_per_cycle = static_cast<double>(row.pixels) * 100 * static_cast<double>(ars::kNanosecond) /
                           static_cast<double>(played.drawing);
  row.memory_cycle_ns = ars::averageCycle(cycles, ars::cycleLengths(options.machine.memory_design));
  row.lost_percent = tree_time > 0 ? 100 * lost / tree_time : 0;
  row.blocked_percent = tiler_time > 0 ? 100 * blocked / tiler_time : 0;
  return row;
}

Json stagesJson(const ars::StageTimes& stages) {
  Json json;
  for (std::size_t k = 0; k < ars::kFrameStages; ++k)
    json[std::string(ars::frameStageName(static_cast<ars::FrameStage>(k)))] =
        static_cast<double>(stages.time[k]) / static_cast<double>(ars::kMillisecond);
  return json;
}

Json rowsJson(const std::vector<ArsSweepRow>& rows) {
  Json list = Json::array();
  for (const ArsSweepRow& row : rows) {
    list.push_back({{"value", row.value},
                    {"frame_ms", row.frame_ms},
                    {"reading_ms", row.reading_ms},
                    {"limit", ars::frameStageName(row.stages.limit())},
                    {"stages_ms", stagesJson(row.stages)},
                    {"pixels", row.pixels},
                    {"pixels_per_100ns", row.pixels_per_cycle},
                    {"longest_queue", row.longest_queue},
                    {"memory_cycle_ns", row.memory_cycle_ns},
                    {"arbitration_lost_percent", row.lost_percent},
                    {"tilers_blocked_percent", row.blocked_percent},
                    {"psnr_db", finiteOrNull(row.peak_signal_to_noise)},
                    {"triangle_bits", row.triangle_bits},
                    {"pixel_bits", row.pixel_bits}});
  }
  return list;
}

void printRows(const std::string& key, const std::vector<ArsSweepRow>& rows) {
  std::cout << fmt::format("{:>16} {:>10} {:>8} {:>10} {:>10} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n", key,
                           "frame ms", "limit", "px/100 ns", "longest q", "mem ns", "lost %", "block %",
                           "PSNR dB", "bits/tri", "bits/px");
  for (const ArsSweepRow& row : rows) {
    std::cout << fmt::format(
        "{:>16} {:>10.3f} {:>8} {:>10.3f} {:>10} {:>8.1f} {:>8.2f} {:>8.2f} {:>9} {:>9} {:>9}\n", row.value,
        row.frame_ms, ars::frameStageName(row.stages.limit()), row.pixels_per_cycle, row.longest_queue,
        row.memory_cycle_ns, row.lost_percent, row.blocked_percent,
        std::isfinite(row.peak_signal_to_noise) ? fmt::format("{:.1f}", row.peak_signal_to_noise) : "same",
        row.triangle_bits, row.pixel_bits);
  }
}

std::string sweepSvg(const std::string& key, const std::vector<ArsSweepRow>& rows) {
  const auto panel = [&](const char* title, const char* unit, auto value) {
    LinePanel made{title, key, unit, {{title, {}}}};
    for (std::size_t n = 0; n < rows.size(); ++n) {
      double x = 0;
      const std::string& text = rows[n].value;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
      // Words stand beside each other in the order given.
      if (error != std::errc() || end != text.data() + text.size()) x = static_cast<double>(n);
      made.series[0].points.push_back({x, value(rows[n])});
    }
    return made;
  };
  const LinePanel panels[] = {
      panel("Frame time", "ms", [](const ArsSweepRow& row) { return row.frame_ms; }),
      panel("Longest queue", "pixels",
            [](const ArsSweepRow& row) { return static_cast<double>(row.longest_queue); }),
      panel("Lost in arbitration", "% of the tree's time",
            [](const ArsSweepRow& row) { return row.lost_percent; }),
      panel("Picture against the judge", "dB",
            [](const ArsSweepRow& row) { return row.peak_signal_to_noise; })};
  return lineSvg("The machine of 1983: " + key, panels);
}

}  // namespace

void addArsSweepOptions(CLI::App& app, ArsSweepOptions& options) {
  addPathOption(app, "STREAM.ars", options.stream, "A stream that dbview --engine ars --record wrote")
      ->required();
  app.add_option("--key", options.key, "The setting to vary, a key of --ars")->required()->type_name("KEY");
  app.add_option("--values", options.values, "Its values, with commas between")
      ->required()
      ->type_name("VALUE,...");
  app.add_option("--ars", options.ars, "All other settings (default: the report's machine)")
      ->type_name("KEY=VALUE,...");
  addPathOption(app, "--against", options.against,
                "Hold pictures against this one, e.g. of --engine reference (default: the machine of the "
                "other settings)")
      ->type_name("FILE.png");
  addReportOption(app, options.reports);
  addCommonOptions(app, options.common, true);
}

Result<int> runArsSweep(const ArsSweepOptions& options) {
  DELTAZ_TRY_ASSIGN(ArsOptions base, parseArsOptions(options.ars));
  base.timed = true;
  const std::vector<std::string> values = valuesOf(options.values);
  if (values.size() > kMostValues)
    return usageError("--values", fmt::format("{} values are more than {}", values.size(), kMostValues));
  for (const char* fixed : {"timing", "passes", "antialiaser", "sampling"}) {
    if (options.key == fixed)
      return usageError("--key", fmt::format("{} is not a setting of the machine that plays a stream", fixed),
                        {}, "Record one stream for each value, or choose another key");
  }
  const std::string others = "," + options.ars;
  if (others.find("," + options.key + "=") != std::string::npos)
    return usageError("--ars", fmt::format("{} is what is swept", options.key), {}, "Leave it out of --ars");
  std::vector<ArsOptions> machines;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const std::string& value = values[n];
    if (std::find(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), value) !=
        values.begin() + static_cast<std::ptrdiff_t>(n))
      return usageError("--values", fmt::format("{} stands there twice", value), {}, "Give each value once");
    ArsOptions machine = base;
    DELTAZ_TRY(setArsOption(options.key, value, machine, "--key"));
    DELTAZ_TRY(ars::validate(machine.machine));
    DELTAZ_TRY(ars::checkNumberProfile(machine.tiler.numbers));
    machines.push_back(std::move(machine));
  }
  DELTAZ_TRY_ASSIGN(const ReportPaths paths, parseReportPaths(options.reports, options.common.overwrite));
  DELTAZ_TRY_ASSIGN(const int threads, options.common.threads());
  DELTAZ_TRY_ASSIGN(const ars::TriangleStream stream,
                    ars::readTriangleStream(localFileSystem(), options.stream));
  ProgressReporter progress(progressMode(options.common), "dbview", std::cerr);
  std::vector<ArsSweepRow> rows;
  DELTAZ_TRY(drawOnThreads(threads, [&]() -> Result<Picture> {
    Colors judge;
    if (options.against.empty()) {
      DELTAZ_TRY_ASSIGN(ars::PlayedStream played, ars::playStream(stream, base));
      judge = std::move(played.color);
    } else {
      DELTAZ_TRY_ASSIGN(judge, colorsOf(options.against, stream));
    }
    for (std::size_t n = 0; n < machines.size(); ++n) {
      progress.report(fmt::format("{}={}", options.key, values[n]),
                      static_cast<double>(n) / static_cast<double>(machines.size()));
      DELTAZ_TRY_ASSIGN(const ars::PlayedStream played, ars::playStream(stream, machines[n]));
      rows.push_back(rowOf(values[n], machines[n], played, judge));
    }
    return Picture{};
  }));
  progress.report("done", 1);

  Json json = jsonHeader("dbview ars-sweep");
  json["stream"] = baseName(options.stream);
  json["key"] = options.key;
  json["settings"] = describeArsOptions(base);
  json["rows"] = rowsJson(rows);
  const bool overwrite = options.common.overwrite;
  if (!paths.json.empty()) DELTAZ_TRY(writeOutput(paths.json, jsonText(json), overwrite));
  if (!paths.svg.empty()) DELTAZ_TRY(writeOutput(paths.svg, sweepSvg(options.key, rows), overwrite));
  if (options.common.json) {
    std::cout << jsonText(json);
  } else if (!options.common.quiet) {
    printRows(options.key, rows);
  }
  return kExitDone;
}

}  // namespace deltaz
