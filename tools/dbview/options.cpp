#include "tools/dbview/options.h"

#include <fmt/format.h>
#include <utility>

#include "formats/file_system.h"
#include "libdb/access/ground_query.h"
#include "librender/scene/environment.h"
#include "tools/common/output_file.h"
#include "tools/common/parse.h"
#include "tools/dbview/pose_file.h"

namespace deltaz {

namespace {

constexpr double kSmallestFieldOfView = 0.001, kLargestFieldOfView = 179;  // degrees
constexpr double kLargestTolerance = 1e6;                                  // pixels
constexpr int kLargestRepeat = 1000000;

Status checkOutputs(const ViewOptions& options) {
  if (!options.output.ends_with(".png")) {
    return usageError(options.output, "this version writes PNG; the name must end in .png");
  }
  if (!options.depth_path.empty() && !options.depth_path.ends_with(".tif") &&
      !options.depth_path.ends_with(".tiff")) {
    return usageError(options.depth_path, "depth is written as TIFF; the name must end in .tif");
  }
  const auto same = [](const std::string& a, const std::string& b) {
    return !a.empty() && !b.empty() &&
           joinPath(parentPath(a), baseName(a)) == joinPath(parentPath(b), baseName(b));
  };
  for (const auto& [a, b] :
       {std::pair(options.output, options.depth_path), std::pair(options.output, options.statistics_path),
        std::pair(options.depth_path, options.statistics_path)}) {
    if (same(a, b))
      return usageError(a, "two results would go into one file", {}, "Give each a name of its own");
  }
  for (const std::string& path : {options.output, options.depth_path, options.statistics_path}) {
    if (!path.empty()) DELTAZ_TRY(checkOutput(path, options.common.overwrite));
  }
  return Success{};
}

}  // namespace

void addViewOptions(CLI::App& app, ViewOptions& options) {
  addPathOption(app, "AREA.dz", options.area, "The database")->required();
  addPathOption(app, "-o,--output", options.output, "The picture to write, PNG")
      ->required()
      ->type_name("OUT.png");
  app.add_option(
         "--eye", options.eye,
         "Where the eye is: degrees, degrees, metres above the database's datum, or above ground with agl "
         "(46.9,-121.8,120agl). Without it the whole area is shown")
      ->type_name("LAT,LON,ALT");
  app.add_option("--look", options.look,
                 "Where it looks: degrees clockwise from north, degrees up, degrees right wing down")
      ->type_name("HEADING,PITCH[,ROLL]");
  app.add_option("--fov", options.field_of_view, "Horizontal field of view, degrees (default: 60)")
      ->type_name("DEG");
  app.add_option("--size", options.size, "Size of the picture, pixels (default: 1280x720)")->type_name("WxH");
  app.add_option("--color", options.color,
                 "The colour map to draw with (default: the first), or none for colours made from altitude "
                 "and slope")
      ->type_name("NAME");
  app.add_option("--sun", options.sun,
                 "Where the sun is, seen from the area's centre, degrees (default: 225,40)")
      ->type_name("AZIMUTH,ELEVATION");
  app.add_option("--tolerance", options.tolerance,
                 "Largest error on the screen, pixels; 0 draws full resolution (default: 1)")
      ->type_name("PX");
  app.add_option(
         "--lod", options.lod,
         "How coarse the terrain may be: error, within --tolerance, or report, by range as in 1983: no "
         "error is bounded, and there are cracks (default: error)")
      ->check(CLI::IsMember({"error", "report"}))
      ->type_name("SCHEME");
  app.add_option("--engine", options.engine,
                 "fast, or reference: double precision, every triangle (default: fast)")
      ->check(CLI::IsMember({"fast", "reference"}))
      ->type_name("ENGINE");
  addPathOption(app, "--pose", options.pose_path, "Where parts of models have moved to, see dbview(1)")
      ->type_name("FILE.json");
  addPathOption(app, "--stats", options.statistics_path, "Write statistics of the frame as JSON")
      ->type_name("FILE.json");
  addPathOption(app, "--depth", options.depth_path,
                "Write depth as a TIFF of 32-bit floats: metres along the view axis")
      ->type_name("FILE.tif");
  app.add_option("--repeat", options.repeat, "Render this many times, for the times in --stats (default: 1)")
      ->type_name("N");
  addCommonOptions(app, options.common, true);
  app.footer(
      "Exit codes: 0 done; 1 damaged or not a database; 2 usage, target exists; 3 cannot read or write; 4 "
      "newer format;\n"
      "70 internal error. See dbview(1).");
}

Result<View> parseView(const ViewOptions& options) {
  View view;
  RenderOptions& render = view.render;
  DELTAZ_TRY_ASSIGN(render.threads, options.common.threads());
  if (options.eye.empty() != options.look.empty()) {
    return usageError(options.eye.empty() ? "--look" : "--eye", "--eye and --look go together");
  }
  if (!options.eye.empty()) {
    DELTAZ_TRY_ASSIGN(const EyePosition eye, parseEye(options.eye, "--eye"));
    DELTAZ_TRY_ASSIGN(const LookDirection look, parseLook(options.look, "--look"));
    render.camera.eye = {eye.latitude, eye.longitude, eye.altitude};
    render.camera.heading = look.heading;
    render.camera.pitch = look.pitch;
    render.camera.roll = look.roll;
  }
  DELTAZ_TRY_ASSIGN(
      render.camera.field_of_view,
      parseNumberBetween(options.field_of_view, "--fov", kSmallestFieldOfView, kLargestFieldOfView));
  DELTAZ_TRY_ASSIGN(const PictureSize size, parseSize(options.size, "--size"));
  render.camera.width = size.width;
  render.camera.height = size.height;
  if (!options.sun.empty()) {
    DELTAZ_TRY_ASSIGN(const SunDirection sun, parseSun(options.sun, "--sun"));
    render.sun = {sun.azimuth, sun.elevation};
  }
  render.color_map = options.color;
  DELTAZ_TRY_ASSIGN(render.tolerance,
                    parseNumberBetween(options.tolerance, "--tolerance", 0, kLargestTolerance));
  render.lod = options.lod == "report" ? LodScheme::kReport : LodScheme::kError;
  DELTAZ_TRY_ASSIGN(const std::int64_t repeat, parseInteger(options.repeat, "--repeat", 1, kLargestRepeat));
  view.repeat = static_cast<int>(repeat);
  view.engine = options.engine == "reference" ? EngineKind::kReference : EngineKind::kFast;
  if (view.engine == EngineKind::kReference && render.lod == LodScheme::kReport) {
    return usageError("--lod", "the reference engine draws every triangle, there are no levels to choose", {},
                      "Leave out --lod report, or --engine reference");
  }
  DELTAZ_TRY(checkOutputs(options));
  if (!options.pose_path.empty()) {
    DELTAZ_TRY_ASSIGN(render.poses, readPoseFile(options.pose_path));
  }
  return view;
}

Status placeCamera(const Database& database, const ViewOptions& options, View& view) {
  Camera& camera = view.render.camera;
  if (options.eye.empty()) {
    camera = wholeAreaCamera(database.area(), camera.width, camera.height, camera.field_of_view);
    if (camera.heading == 0) camera.heading = 0;  // a negative zero would be printed as one
    return Success{};
  }
  DELTAZ_TRY_ASSIGN(const EyePosition eye, parseEye(options.eye, "--eye"));
  if (!eye.above_ground) return Success{};
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground, groundHeight(database, eye.latitude, eye.longitude));
  if (!ground) {
    return usageError("--eye", fmt::format("there is no ground at {},{}", eye.latitude, eye.longitude),
                      "the position is outside the area or at a void",
                      "Give the altitude above the datum, without agl");
  }
  camera.eye.height = *ground + eye.altitude;
  return Success{};
}

Status checkColorMap(const Database& database, const ViewOptions& options) {
  const Result<const ColorMap*> chosen = chooseColorMap(database, options.color);
  if (chosen.ok()) return Success{};
  Error error = chosen.error();
  error.where = "--color: " + error.where;
  return error;
}

const char* engineName(EngineKind kind) {
  return kind == EngineKind::kReference ? "reference" : "fast";
}

const char* lodName(LodScheme lod) {
  return lod == LodScheme::kReport ? "report" : "error";
}

}  // namespace deltaz
