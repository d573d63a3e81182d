#include "tools/dbview/camera_options.h"

#include <fmt/format.h>

#include "libdb/access/ground_query.h"
#include "tools/common/parse.h"

namespace deltaz {

namespace {

constexpr double kSmallestFieldOfView = 0.001, kLargestFieldOfView = 179;  // degrees

}  // namespace

Result<CameraRequest> parseCamera(const CameraText& text, const std::string& where) {
  const auto option = [&](const char* name) { return where.empty() ? name : where + ", " + name; };
  if (text.eye.empty() != text.look.empty()) {
    return usageError(option(text.eye.empty() ? "--look" : "--eye"), "--eye and --look go together");
  }
  CameraRequest request;
  Camera& camera = request.camera;
  request.whole_area = text.eye.empty();
  if (!request.whole_area) {
    DELTAZ_TRY_ASSIGN(const EyePosition eye, parseEye(text.eye, option("--eye")));
    DELTAZ_TRY_ASSIGN(const LookDirection look, parseLook(text.look, option("--look")));
    camera.eye = {eye.latitude, eye.longitude, eye.altitude};
    camera.heading = look.heading;
    camera.pitch = look.pitch;
    camera.roll = look.roll;
    request.above_ground = eye.above_ground;
  }
  DELTAZ_TRY_ASSIGN(camera.field_of_view, parseNumberBetween(text.field_of_view, option("--fov"),
                                                             kSmallestFieldOfView, kLargestFieldOfView));
  DELTAZ_TRY_ASSIGN(const PictureSize size, parseSize(text.size, option("--size")));
  camera.width = size.width;
  camera.height = size.height;
  return request;
}

Result<Camera> placeCamera(const Database& database, const CameraRequest& request, const std::string& where) {
  Camera camera = request.camera;
  if (request.whole_area) {
    camera = wholeAreaCamera(database.area(), camera.width, camera.height, camera.field_of_view);
    if (camera.heading == 0) camera.heading = 0;  // a negative zero would be printed as one
    return camera;
  }
  if (!request.above_ground) return camera;
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                    groundHeight(database, camera.eye.latitude, camera.eye.longitude));
  if (!ground) {
    return usageError(where.empty() ? "--eye" : where + ", --eye",
                      fmt::format("there is no ground at {},{}", camera.eye.latitude, camera.eye.longitude),
                      "the position is outside the area or at a void",
                      "Give the altitude above the datum, without agl");
  }
  camera.eye.height += *ground;
  return camera;
}

}  // namespace deltaz
