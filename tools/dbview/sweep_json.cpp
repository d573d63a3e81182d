#include "tools/dbview/sweep_json.h"

#include <algorithm>

#include "tools/dbview/options.h"
#include "tools/dbview/statistics_json.h"

namespace deltaz {

namespace {

Json rowsJson(const SweepReport& report, const std::vector<SweepRow>& rows) {
  const std::vector<std::size_t> moved = frontOf(rows, SweepMeasure::kDisplacement),
                                 colored = frontOf(rows, SweepMeasure::kPicture);
  const auto is_in = [](const std::vector<std::size_t>& front, std::size_t k) {
    return std::find(front.begin(), front.end(), k) != front.end();
  };
  Json json = Json::array();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SweepRow& row = rows[k];
    Json one;
    const bool by_range = row.setting.lod == LodScheme::kReport;
    one["setting"] = {{"tolerance", by_range ? Json(nullptr) : Json(row.setting.tolerance)},
                      {"lod", lodName(row.setting.lod)},
                      {"transform", transformName(row.setting.transform)},
                      {"samples", row.setting.samples},
                      {"quantum", report.quanta[row.setting.database]}};
    one["frame_ms"] = {{"min", row.milliseconds.minimum},
                       {"median", row.milliseconds.median},
                       {"max", row.milliseconds.maximum}};
    one["displacement_pixels"] = {{"largest", finiteOrNull(row.displacement.largest)},
                                  {"p99_9", finiteOrNull(row.displacement.nearly_all)},
                                  {"rms", finiteOrNull(row.displacement.root_mean_square)},
                                  {"bound", finiteOrNull(row.statistics.projected_error)}};
    one["measured_pixels"] = row.displacement.measured;
    one["unmeasured_pixels"] = row.displacement.unmeasured;
    one["colors"] = {{"differing_share", row.picture.differingShare()},
                     {"largest_difference", row.picture.largest},
                     {"rms", errorOf(row, SweepMeasure::kPicture)},
                     {"psnr_db", finiteOrNull(row.picture.peakSignalToNoise())}};
    one["triangles_drawn"] = row.statistics.triangles.drawn;
    one["posts_decoded"] = row.statistics.posts_decoded;
    one["bytes_read"] = row.statistics.bytes_read;
    one["on_front"] = {{"displacement", is_in(moved, k)}, {"colors", is_in(colored, k)}};
    json.push_back(std::move(one));
  }
  return json;
}

Json loadJson(double load) {
  return load >= 0 ? Json(load) : Json(nullptr);
}

}  // namespace

Json sweepJson(const SweepReport& report) {
  Json json = jsonHeader("dbview");
  json["command"] = "sweep";
  json["area"] = report.area;
  json["repeat"] = report.repeats;
  json["reference_tolerance"] = report.reference_tolerance;
  json["reference_samples"] = report.reference_samples;
  json["pattern"] = samplePatternName(report.sampling.pattern);
  json["filter"] = filterName(report.sampling.filter);
  json["machine"] = {{"processors", report.machine.processors},
                     {"threads", report.machine.threads},
                     {"load_before", loadJson(report.machine.load_before)},
                     {"load_after", loadJson(report.machine.load_after)}};
  json["views"] = Json::array();
  for (const SweepOfView& view : report.views) {
    json["views"].push_back({{"name", view.view.name},
                             {"camera", cameraJson(view.view.camera)},
                             {"rows", rowsJson(report, view.rows)}});
  }
  json["all_views"] = rowsJson(report, report.all);
  json["sentences"] = {{"displacement", frontSentence(report, SweepMeasure::kDisplacement)},
                       {"colors", frontSentence(report, SweepMeasure::kPicture)}};
  return json;
}

}  // namespace deltaz
