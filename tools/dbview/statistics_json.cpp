#include "tools/dbview/statistics_json.h"

#include <utility>
#include <vector>

#include "formats/file_system.h"
#include "librender/ars/engine/ars_frame.h"
#include "librender/ars/machine/control_status_board.h"
#include "librender/sweep/spread.h"

namespace deltaz {

namespace {

template <typename Value>
Spread spreadOfTimes(std::span<const FrameStatistics> repeats, Value value) {
  std::vector<double> values;
  for (const FrameStatistics& frame : repeats) values.push_back(value(frame.milliseconds));
  return spreadOf(std::move(values));
}

Json stagesJson(std::span<const FrameStatistics> repeats) {
  using Milliseconds = FrameStatistics::Milliseconds;
  const auto median = [repeats](double Milliseconds::*stage) {
    return finiteOrNull(
        spreadOfTimes(repeats, [stage](const Milliseconds& times) { return times.*stage; }).median);
  };
  Json json;
  json["schedule"] = median(&Milliseconds::schedule);
  json["read"] = median(&Milliseconds::read);
  json["objects"] = median(&Milliseconds::objects);
  json["raster"] = median(&Milliseconds::raster);
  json["resolve"] = median(&Milliseconds::resolve);
  return json;
}

Json objectsJson(const FrameStatistics::Objects& objects) {
  return {{"out_of_view", objects.out_of_view},
          {"drawn", objects.drawn},
          {"drawn_twice", objects.drawn_twice},
          {"faces", objects.faces},
          {"faces_twice", objects.faces_twice}};
}

// Simulated times in milliseconds; the runs as the control/status board counted them.
Json machineJson(const ars::Frame& frame, const ars::MachineConfiguration& configuration) {
  const auto milliseconds = [](ars::Picoseconds time) {
    return static_cast<double>(time) / static_cast<double>(ars::kMillisecond);
  };
  Json json;
  json["settings"] = frame.settings;
  json["passes"] = frame.passes;
  json["sub_images"] = frame.sub_images;
  json["background_triangles"] = frame.background;
  json["pretiler"] = {{"in", frame.pretiler.in},
                      {"before_hither", frame.pretiler.before_hither},
                      {"beside", frame.pretiler.beside},
                      {"edge_on", frame.pretiler.edge_on},
                      {"drawn", frame.pretiler.drawn},
                      {"cut_by_hither", frame.pretiler.cut_by_hither},
                      {"cut_by_screen", frame.pretiler.cut_by_screen},
                      {"out", frame.pretiler.out}};
  json["drawing_ms"] = frame.timed ? Json(milliseconds(frame.drawing)) : Json(nullptr);
  json["reading_ms"] = frame.timed ? Json(milliseconds(frame.reading)) : Json(nullptr);
  json["runs"] = Json::array();
  for (const ars::FrameRun& run : frame.runs) {
    Json each;
    each["sub_image"] = run.sub_image;
    each["pass"] = run.pass;
    each["triangles"] = run.triangles;
    for (std::size_t k = 0; k < ars::kWriteCycleCount; ++k)
      each["cycles"][std::string(ars::memoryCycleName(static_cast<ars::MemoryCycle>(k)))] =
          run.memory.cycles[k];
    if (frame.timed) each["board"] = Json::parse(ars::statisticsJson(run.statistics, configuration));
    json["runs"].push_back(std::move(each));
  }
  return json;
}

Json frameJson(std::span<const FrameStatistics> repeats, const RenderOptions& render) {
  const LodScheme lod = render.lod;
  const FrameStatistics& first = repeats.front();
  Json json;
  json["nodes"] = {{"visited", first.nodes.visited},
                   {"out_of_view", first.nodes.out_of_view},
                   {"beyond_horizon", first.nodes.beyond_horizon},
                   {"facing_away", first.nodes.facing_away},
                   {"occluded", first.nodes.occluded},
                   {"drawn", first.nodes.drawn},
                   {"opened", first.nodes.opened},
                   {"empty", first.nodes.empty}};
  const FrameStatistics::FullResolution& full = first.full_resolution;
  json["full_resolution_triangles"] = {
      {"out_of_view", full.out_of_view}, {"beyond_horizon", full.beyond_horizon},
      {"facing_away", full.facing_away}, {"occluded", full.occluded},
      {"coarser", full.coarser},         {"drawn", full.drawn}};
  if (lod == LodScheme::kReport) json["objects"] = objectsJson(first.objects);
  json["models"] = {{"visited", first.models.visited},
                    {"out_of_view", first.models.out_of_view},
                    {"occluded", first.models.occluded},
                    {"drawn", first.models.drawn}};
  json["triangles"] = {{"in", first.triangles.in},
                       {"back_facing", first.triangles.back_facing},
                       {"clipped", first.triangles.clipped},
                       {"no_sample", first.triangles.no_sample},
                       {"drawn", first.triangles.drawn}};
  json["triangles_hidden"] = first.triangles.hidden;
  json["samples"] = {
      {"tested", first.samples.tested}, {"written", first.samples.written}, {"shaded", first.samples.shaded}};
  json["bytes_read"] = first.bytes_read;
  json["posts_decoded"] = first.posts_decoded;
  json["color_tiles"] = first.color_tiles;
  json["depth_complexity"] = finiteOrNull(first.depth_complexity);
  json["level"] = first.level;
  json["coarsest_level"] = first.coarsest_level;
  json["projected_error"] = finiteOrNull(first.projected_error);
  json["transform_error"] = finiteOrNull(first.transform_error);
  if (first.ars != nullptr) json["ars"] = machineJson(*first.ars, render.ars.machine);
  json["stages_ms"] = stagesJson(repeats);
  const Spread total =
      spreadOfTimes(repeats, [](const FrameStatistics::Milliseconds& times) { return times.total; });
  json["frame_ms"] = {{"min", finiteOrNull(total.minimum)},
                      {"median", finiteOrNull(total.median)},
                      {"max", finiteOrNull(total.maximum)}};
  return json;
}

}  // namespace

Json cameraJson(const Camera& camera) {
  Json json;
  json["eye"] = {
      {"latitude", camera.eye.latitude}, {"longitude", camera.eye.longitude}, {"height", camera.eye.height}};
  json["heading"] = camera.heading;
  json["pitch"] = camera.pitch;
  json["roll"] = camera.roll;
  json["field_of_view"] = camera.field_of_view;
  json["width"] = camera.width;
  json["height"] = camera.height;
  return json;
}

Json statisticsJson(const std::string& area, const View& view, std::span<const FrameStatistics> repeats) {
  Json json = jsonHeader("dbview");
  json["area"] = baseName(area);
  json["engine"] = engineName(view.engine);
  json["tolerance"] = view.render.tolerance;
  json["lod"] = lodName(view.render.lod);
  json["transform"] = transformName(view.render.transform);
  json["samples"] = view.render.sampling.count;
  json["pattern"] = samplePatternName(view.render.sampling.pattern);
  json["filter"] = filterName(view.render.sampling.filter);
  json["repeat"] = repeats.size();
  json["camera"] = cameraJson(view.render.camera);
  json["sun"] = {{"azimuth", view.render.sun.azimuth}, {"elevation", view.render.sun.elevation}};
  json["frames"] = Json::array({frameJson(repeats, view.render)});
  return json;
}

}  // namespace deltaz
