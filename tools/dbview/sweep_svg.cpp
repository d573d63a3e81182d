#include "tools/dbview/sweep_svg.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

#include "tools/common/scatter_svg.h"

namespace deltaz {

namespace {

ScatterPanel panelOf(const SweepReport& report, SweepMeasure measure) {
  ScatterPanel panel;
  const bool moved = measure == SweepMeasure::kDisplacement;
  panel.title = moved ? "Geometry" : "Colours";
  panel.x_label = "milliseconds a frame (median)";
  panel.y_label =
      moved ? "largest displacement on the screen, pixels" : "root mean square difference, of 255";
  for (const SweepRow& row : report.all) {
    // Points of one group differ in tolerance only.
    const std::string group = knobsName(report, row.setting);
    const auto found = std::find(panel.groups.begin(), panel.groups.end(), group);
    ScatterPoint point;
    point.x = row.milliseconds.median;
    point.y = errorOf(row, measure);
    point.group = static_cast<std::size_t>(found - panel.groups.begin());
    point.label = settingName(report, row.setting);
    if (found == panel.groups.end()) panel.groups.push_back(group);
    panel.points.push_back(point);
  }
  panel.front = frontOf(report.all, measure);
  return panel;
}

}  // namespace

std::string sweepSvg(const SweepReport& report) {
  const ScatterPanel panels[] = {panelOf(report, SweepMeasure::kDisplacement),
                                 panelOf(report, SweepMeasure::kPicture)};
  const Camera& camera = report.views.front().view.camera;
  return scatterSvg(
      fmt::format("{}: run time against error, {} at {} x {}, {} thread{}", report.area,
                  report.views.size() == 1 ? "one view" : fmt::format("{} views", report.views.size()),
                  camera.width, camera.height, report.machine.threads,
                  report.machine.threads == 1 ? "" : "s"),
      panels);
}

}  // namespace deltaz
