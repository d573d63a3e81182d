// The command line of dbview sweep, and the sweep it asks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/dbview/sampling_options.h"
#include "tools/dbview/scene_options.h"
#include "tools/dbview/sweep_views.h"

namespace deltaz {

struct SweepOptions {
  CommonOptions common;
  SceneOptions scene;
  std::string area, views_path;
  std::string tolerances = "0.25,0.5,1,2,4";
  std::string quanta;
  std::string lods = "error";
  std::string transforms = "exact";
  std::string samples = "1";
  SamplingOptions sampling;
  std::string reference = "0";
  std::string repeat = "5";
  std::vector<std::string> reports;
};

void addSweepOptions(CLI::App& app, SweepOptions& options);

// What the options say as far as it can be judged without a database.
struct SweepPlan {
  RenderOptions render;  // of every frame
  CameraRequest camera;  // of the one view, or size and field of view of those made from the area
  bool views_of_area = false;
  std::vector<NamedCameraRequest> views;  // of --views
  std::vector<double> tolerances;
  std::vector<LodScheme> lods;
  std::vector<TransformKind> transforms;
  std::vector<int> samples;
  std::vector<Rational> quanta;  // beside the database's own
  double reference_tolerance = 0;
  int repeats = 5;
  std::string json_path, svg_path;  // empty: not asked for
};

// Errors: kUsage, kCannotAccess (a report cannot be written, a file cannot be read), kInvalid (the files of
// views and poses).
Result<SweepPlan> parseSweep(const SweepOptions& options);

}  // namespace deltaz
