#include "tools/dbview/scene_options.h"

#include "librender/scene/environment.h"
#include "tools/common/parse.h"
#include "tools/dbview/pose_file.h"

namespace deltaz {

void addSceneOptions(CLI::App& app, SceneOptions& options) {
  app.add_option(
         "--eye", options.camera.eye,
         "Where the eye is: degrees, degrees, metres above the database's datum, or above ground with agl "
         "(46.9,-121.8,120agl). Without it the whole area is shown")
      ->type_name("LAT,LON,ALT");
  app.add_option("--look", options.camera.look,
                 "Where it looks: degrees clockwise from north, degrees up, degrees right wing down")
      ->type_name("HEADING,PITCH[,ROLL]");
  app.add_option("--fov", options.camera.field_of_view, "Horizontal field of view, degrees (default: 60)")
      ->type_name("DEG");
  app.add_option("--size", options.camera.size, "Size of the picture, pixels (default: 1280x720)")
      ->type_name("WxH");
  app.add_option("--color", options.color,
                 "The colour map to draw with (default: the first), or none for colours made from altitude "
                 "and slope")
      ->type_name("NAME");
  app.add_option("--sun", options.sun,
                 "Where the sun is, seen from the area's centre, degrees (default: 225,40)")
      ->type_name("AZIMUTH,ELEVATION");
  addPathOption(app, "--pose", options.pose_path, "Where parts of models have moved to, see dbview(1)")
      ->type_name("FILE.json");
}

Result<RenderOptions> parseScene(const SceneOptions& options, const CommonOptions& common) {
  RenderOptions render;
  DELTAZ_TRY_ASSIGN(render.threads, common.threads());
  if (!options.sun.empty()) {
    DELTAZ_TRY_ASSIGN(const SunDirection sun, parseSun(options.sun, "--sun"));
    render.sun = {sun.azimuth, sun.elevation};
  }
  render.color_map = options.color;
  if (!options.pose_path.empty()) {
    DELTAZ_TRY_ASSIGN(render.poses, readPoseFile(options.pose_path));
  }
  return render;
}

Status checkScene(const Database& database, const SceneOptions& options, const RenderOptions& render) {
  if (const Result<const ColorMap*> chosen = chooseColorMap(database, options.color); !chosen.ok()) {
    Error error = chosen.error();
    error.where = "--color: " + error.where;
    return error;
  }
  return checkPoses(database, render.poses, options.pose_path);
}

}  // namespace deltaz
