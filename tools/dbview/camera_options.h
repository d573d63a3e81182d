// A camera as people write it, on the command line and in files of views.
#pragma once

#include <string>

#include "libdb/access/database.h"
#include "librender/scene/camera.h"

namespace deltaz {

struct CameraText {
  std::string eye, look;  // both or none: the whole area
  std::string field_of_view = "60";
  std::string size = "1280x720";
};

struct CameraRequest {
  Camera camera;
  bool whole_area = false;    // eye and look come from the area
  bool above_ground = false;  // the eye's height counts from the ground
};

// What can be judged without a database. Messages name "--eye" and so on, behind `where` if it is not empty.
// Errors: kUsage.
Result<CameraRequest> parseCamera(const CameraText& text, const std::string& where = {});

// Completes the camera. Errors: kUsage where there is no ground under an eye above ground; whatever reading
// reports.
Result<Camera> placeCamera(const Database& database, const CameraRequest& request,
                           const std::string& where = {});

}  // namespace deltaz
