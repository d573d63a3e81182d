#include "tools/dbview/ars_report_command.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <iostream>
#include <map>

#include "librender/ars/experiments/correction_effects.h"
#include "librender/ars/experiments/depth_resolution.h"
#include "librender/ars/experiments/memory_tables.h"
#include "librender/ars/experiments/tiler_tables.h"
#include "librender/ars/experiments/width_sweep.h"
#include "librender/scenario/scenario_report.h"
#include "tools/common/json_output.h"
#include "tools/common/line_svg.h"
#include "tools/common/output_file.h"
#include "tools/common/parse.h"
#include "tools/common/progress.h"
#include "tools/dbview/report_paths.h"

namespace deltaz {

namespace {

using ars::ReportRow;
using ars::WidthPoint;

constexpr int kLargestTriangles = 1'000'000;
constexpr int kTimingRounds = 5;  // of Tables 28 and 29

struct ArsReport {
  std::vector<ReportRow> rows;
  std::vector<WidthPoint> widths;
};

void append(std::vector<ReportRow>& rows, std::vector<ReportRow> more) {
  rows.insert(rows.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// The sweep's numbers as rows, so that JSON has them in one list.
std::vector<ReportRow> widthRows(const std::vector<WidthPoint>& widths) {
  std::vector<ReportRow> rows;
  for (const WidthPoint& point : widths) {
    std::string name = point.width;
    std::replace(name.begin(), name.end(), ' ', '_');
    const auto add = [&](const char* what, const char* unit, double value) {
      rows.push_back({fmt::format("width.{}.{}.{}", name, point.bits, what),
                      fmt::format("{} of {} bits: {}, {}", point.width, point.bits, what, unit),
                      {},
                      value,
                      point.table_8 ? "Table 8" : ""});
    };
    add("extra", "% of pixels", point.error.extra);
    add("missing", "% of pixels", point.error.missing);
    add("depth_mean", "relative", point.error.depth_mean);
    add("depth_largest", "relative", point.error.depth_largest);
    add("color_mean", "codes", point.error.color_mean);
    add("color_largest", "codes", point.error.color_largest);
    add("triangle_bits", "bits", point.triangle_bits);
    add("pixel_bits", "bits", point.pixel_bits);
  }
  return rows;
}

Json rowsJson(const std::vector<ReportRow>& rows) {
  Json list = Json::array();
  for (const ReportRow& row : rows) {
    Json json;
    json["id"] = row.id;
    json["description"] = row.description;
    json["published"] = valueOrNull(row.published);
    json["ours"] = finiteOrNull(row.ours);
    json["ratio"] = valueOrNull(row.ratio());
    json["note"] = row.note;
    list.push_back(std::move(json));
  }
  return list;
}

void printRows(const std::vector<ReportRow>& rows) {
  std::cout << fmt::format("{:<44} {:>12} {:>12} {:>7}  {}\n", "", "published", "ours", "ratio", "");
  for (const ReportRow& row : rows) {
    const std::string published = row.published ? fmt::format("{:.6g}", *row.published) : "";
    const std::string ratio = row.ratio() ? fmt::format("{:.3f}", *row.ratio()) : "";
    std::cout << fmt::format("{:<44} {:>12} {:>12.6g} {:>7}  {}{}{}\n", row.id, published, row.ours, ratio,
                             row.description, row.note.empty() ? "" : "; ", row.note);
  }
}

// Curves of rows "figureNN.a.b.c", one of whose parts is a number: that is x, the others name the curve.
class Figure {
 public:
  void add(const std::vector<std::string>& parts, const ReportRow& row) {
    std::string series;
    std::optional<double> x;
    for (std::size_t k = 1; k < parts.size(); ++k) {
      std::string_view part = parts[k];
      if (part.starts_with("memory_")) part.remove_prefix(7);
      double value = 0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
      if (!x && error == std::errc() && end == part.data() + part.size()) {
        x = value;
      } else {
        series += (series.empty() ? "" : " ") + parts[k];
      }
    }
    if (!x) return;
    ours_[series].push_back({*x, row.ours});
    // Other triangles of ours are held against the same figures.
    if (row.published && series.find("needles") == std::string::npos)
      published_[series].push_back({*x, *row.published});
  }

  std::vector<LineSeries> series() const {
    std::vector<LineSeries> all;
    for (const auto& [name, points] : ours_) all.push_back({name, points});
    for (const auto& [name, points] : published_) all.push_back({name + ", published", points, true});
    return all;
  }

 private:
  std::map<std::string, std::vector<LinePoint>> ours_, published_;
};

std::vector<std::string> partsOf(const std::string& id) {
  std::vector<std::string> parts(1);
  for (const char c : id) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back().push_back(c);
    }
  }
  return parts;
}

std::string reportSvg(const ArsReport& report) {
  struct Title {
    const char *figure, *title, *x, *y;
  };
  constexpr Title kTitles[] = {
      {"figure29", "Fig 29: queues after a burst", "cycles", "pixels"},
      {"figure30", "Fig 30: effective tilers in bursts", "tilers", "tilers"},
      {"figure84", "Fig 84: use of memory cycles", "triangles", "%"},
      {"figure85", "Fig 85: average memory cycle", "triangles", "ns"},
      {"figure90", "Fig 90: tiling efficiency if every sample is valid", "pixels a triangle", "%"},
      {"figure91", "Fig 91: longest queue", "tilers' clock, %", "pixels"},
      {"figure92", "Fig 92: accesses of memories", "memory", "accesses"},
      {"table23", "Table 23: sampling efficiency", "row", "%"},
      {"table24", "Table 24: pixels tiled", "row", "million pixels a second"},
  };
  std::map<std::string, Figure> figures;
  for (const ReportRow& row : report.rows) {
    const std::vector<std::string> parts = partsOf(row.id);
    // Of the tables, what the two modes measured.
    if (parts[0] == "table23" && parts.back() != "efficiency") continue;
    if (parts[0] == "table24" && parts.back() != "rate") continue;
    figures[parts[0]].add(parts, row);
  }
  std::vector<LinePanel> panels;
  for (const Title& title : kTitles) {
    LinePanel panel{title.title, title.x, title.y, figures[title.figure].series()};
    if (!panel.series.empty()) panels.push_back(std::move(panel));
  }
  std::map<std::string, LinePanel> widths;
  for (const WidthPoint& point : report.widths) {
    LinePanel& panel = widths[point.width];
    panel.title = "Error and " + point.width;
    panel.x_label = "bits";
    panel.y_label = "mean error: coverage %, colour codes, depth in millionths";
    panel.logarithmic_y = true;
    panel.series.resize(3);
    const auto bits = static_cast<double>(point.bits);
    panel.series[0].name = "coverage";
    panel.series[0].points.push_back({bits, point.error.extra + point.error.missing});
    panel.series[1].name = "colour";
    panel.series[1].points.push_back({bits, point.error.color_mean});
    panel.series[2].name = "depth";
    panel.series[2].points.push_back({bits, 1e6 * point.error.depth_mean});
  }
  for (auto& [name, panel] : widths) panels.push_back(std::move(panel));
  return lineSvg("The machine of 1983: published (dashed) and ours", panels);
}

}  // namespace

void addArsReportOptions(CLI::App& app, ArsReportOptions& options) {
  app.add_option("--triangles", options.triangles,
                 "Random triangles a row of Tables 23 and 24 (default: 2000, as the report took)")
      ->type_name("N");
  addReportOption(app, options.reports);
  addCommonOptions(app, options.common, true);
}

Result<int> runArsReport(const ArsReportOptions& options) {
  DELTAZ_TRY_ASSIGN(const std::int64_t triangles,
                    parseInteger(options.triangles, "--triangles", 1, kLargestTriangles));
  DELTAZ_TRY_ASSIGN(const ReportPaths paths, parseReportPaths(options.reports, options.common.overwrite));
  ProgressReporter progress(progressMode(options.common), "dbview", std::cerr);
  ArsReport report;
  report.rows = ars::table2Rows();
  progress.report("tilers", 0.05);
  append(report.rows, ars::tilerReportRows(static_cast<int>(triangles)));
  progress.report("corrections", 0.4);
  append(report.rows, ars::correctionRows());
  progress.report("memories and distribution tree", 0.5);
  append(report.rows, ars::memoryReportRows());
  progress.report("object processors and levels of detail", 0.7);
  DELTAZ_TRY_ASSIGN(std::vector<ReportRow> of_scene, scenarioReportRows(kTimingRounds));
  append(report.rows, std::move(of_scene));
  progress.report("widths of numbers", 0.8);
  report.widths = ars::sweepWidths(ars::grazingTerrain());
  append(report.rows, widthRows(report.widths));
  progress.report("done", 1);

  Json json = jsonHeader("dbview ars-report");
  json["rows"] = rowsJson(report.rows);
  const bool overwrite = options.common.overwrite;
  if (!paths.json.empty()) DELTAZ_TRY(writeOutput(paths.json, jsonText(json), overwrite));
  if (!paths.svg.empty()) DELTAZ_TRY(writeOutput(paths.svg, reportSvg(report), overwrite));
  if (options.common.json) {
    std::cout << jsonText(json);
  } else if (!options.common.quiet) {
    printRows(report.rows);
  }
  return kExitDone;
}

}  // namespace deltaz
