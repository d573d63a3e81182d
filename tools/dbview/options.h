// dbview's command line, and the view it asks for.
#pragma once

#include <string>

#include "librender/scene/render.h"
#include "tools/common/command_line.h"
#include "tools/dbview/sampling_options.h"
#include "tools/dbview/scene_options.h"

namespace deltaz {

struct ViewOptions {
  CommonOptions common;
  std::string area, output;
  SceneOptions scene;
  std::string tolerance = "1";
  std::string samples = "1";
  SamplingOptions sampling;
  std::string lod = "error";
  std::string transform = "exact";
  std::string engine = "fast";
  std::string ars;     // settings of the machine
  std::string record;  // where to write the stream of triangles it draws
  std::string simd = "auto";
  std::string statistics_path, depth_path;
  std::string repeat = "1";
};

void addViewOptions(CLI::App& app, ViewOptions& options);

// A view ready to render.
struct View {
  RenderOptions render;  // its camera is complete once that below was placed
  CameraRequest camera;
  EngineKind engine = EngineKind::kFast;
  int repeat = 1;
  std::string record_path;  // empty: not asked for
};

// Everything of the options that can be judged without a database; the file of poses is read, and --simd is
// set for the process. Errors: kUsage, kCannotAccess (an output cannot be written), kInvalid (the file of
// poses).
Result<View> parseView(const ViewOptions& options);

const char* engineName(EngineKind kind);
const char* lodName(LodScheme lod);

}  // namespace deltaz
