// The options every picture of a database has, whatever is made of it: where from, in what light, with which
// colours, and where parts have moved to.
#pragma once

#include <string>

#include "libdb/access/database.h"
#include "librender/scene/render.h"
#include "tools/common/command_line.h"
#include "tools/dbview/camera_options.h"

namespace deltaz {

struct SceneOptions {
  CameraText camera;
  std::string color, sun, pose_path;
};

void addSceneOptions(CLI::App& app, SceneOptions& options);

// Sun, colour map, poses (the file is read) and threads; the camera is not set. Errors: kUsage, kInvalid (the
// file of poses), kCannotAccess.
Result<RenderOptions> parseScene(const SceneOptions& options, const CommonOptions& common);

// kUsage if the database has no such colour map or nothing of what poses name.
Status checkScene(const Database& database, const SceneOptions& options, const RenderOptions& render);

}  // namespace deltaz
