// dbview's command line, and the view it asks for.
#pragma once

#include <string>

#include "libdb/access/database.h"
#include "librender/scene/render.h"
#include "tools/common/command_line.h"

namespace deltaz {

struct ViewOptions {
  CommonOptions common;
  std::string area, output;
  std::string eye, look;
  std::string field_of_view = "60";
  std::string size = "1280x720";
  std::string sun;
  std::string tolerance = "1";
  std::string lod = "error";
  std::string color;
  std::string engine = "fast";
  std::string statistics_path, depth_path, pose_path;
  std::string repeat = "1";
};

void addViewOptions(CLI::App& app, ViewOptions& options);

// A view ready to render.
struct View {
  RenderOptions render;
  EngineKind engine = EngineKind::kFast;
  int repeat = 1;
};

// Everything of the options that can be judged without a database; the file of poses is read. The camera is
// complete but for an eye above ground. Errors: kUsage, kCannotAccess (an output cannot be written), kInvalid
// (the file of poses).
Result<View> parseView(const ViewOptions& options);

// Completes the camera: the whole-area view where no eye was given, ground height where it stands above
// ground. Errors: kUsage where there is no ground under an eye above ground; whatever reading reports.
Status placeCamera(const Database& database, const ViewOptions& options, View& view);

// kUsage if the database does not have the colour map that was asked for.
Status checkColorMap(const Database& database, const ViewOptions& options);

const char* engineName(EngineKind kind);
const char* lodName(LodScheme lod);

}  // namespace deltaz
