// The views a sweep draws: those of a file, the one of the command line, or, where nothing is said, four made
// from the area.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "libdb/access/database.h"
#include "librender/sweep/sweep.h"
#include "tools/dbview/camera_options.h"

namespace deltaz {

struct NamedCameraRequest {
  std::string name;
  CameraRequest camera;
};

// The file of --views, specified in dbview(1), VIEWS; what a view leaves out is taken from `common`. Errors:
// kInvalid for text that is no such file, kCannotAccess.
Result<std::vector<NamedCameraRequest>> parseViews(std::string_view text, const std::string& where,
                                                   const CameraText& common);
Result<std::vector<NamedCameraRequest>> readViewsFile(const std::string& path, const CameraText& common);

// Errors: as placeCamera.
Result<std::vector<SweepView>> placeViews(const Database& database,
                                          const std::vector<NamedCameraRequest>& requests);

// The whole area; eye level, 2 m above ground, looking north to the horizon (left out where the area has no
// ground near its middle meridian); oblique, over the southern part; zenith, straight down on the middle
// half. `like` gives size and field of view.
Result<std::vector<SweepView>> defaultViews(const Database& database, const Camera& like);

}  // namespace deltaz
