// dbview: a database and a viewpoint in, a picture out; or what accuracy costs. See dbview(1).
#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <string_view>
#include <vector>

#include "librender/ars/engine/ars_engine.h"
#include "librender/scene/conservation.h"
#include "tools/common/depth_tiff.h"
#include "tools/common/output_file.h"
#include "tools/common/png_file.h"
#include "tools/common/progress.h"
#include "tools/dbview/ars_report_command.h"
#include "tools/dbview/ars_sweep_command.h"
#include "tools/dbview/depth_description.h"
#include "tools/dbview/options.h"
#include "tools/dbview/statistics_json.h"
#include "tools/dbview/sweep_command.h"

namespace deltaz {

namespace {

struct Frame {
  Picture picture;
  std::vector<FrameStatistics> repeats;
  ars::TriangleStream recorded;  // of the first, if it is asked for
};

// Renders as often as asked. A frame that comes out differently the second time breaks a promise of the
// engines. The first leaves its stream where one is to be recorded.
Result<Frame> renderFrame(const Database& database, const View& view, const CommonOptions& common) {
  ProgressReporter progress(progressMode(common), "dbview", std::cerr);
  const std::unique_ptr<Engine> engine = makeEngine(view.engine);
  Frame frame;
  for (int i = 0; i < view.repeat; ++i) {
    progress.report("rendering", static_cast<double>(i) / view.repeat);
    FrameStatistics statistics;
    Picture picture;
    if (i == 0 && !view.record_path.empty()) {
      DELTAZ_TRY_ASSIGN(RecordedFrame made, renderAndRecord(database, view.render, statistics));
      picture = std::move(made.picture);
      frame.recorded = std::move(made.stream);
    } else {
      DELTAZ_TRY_ASSIGN(picture, engine->render(database, view.render, statistics));
    }
    if (const std::string loss = findLoss(statistics); !loss.empty())
      return internalError(engineName(view.engine), loss);
    frame.repeats.push_back(statistics);
    if (i > 0 && (picture.rgb != frame.picture.rgb || picture.depth != frame.picture.depth)) {
      return internalError(engineName(view.engine),
                           fmt::format("frame {} is not the picture of frame 1", i + 1));
    }
    frame.picture = std::move(picture);
  }
  progress.report("done", 1);
  return frame;
}

void printSummary(const ViewOptions& options, const View& view, const Json& statistics) {
  if (options.common.json) {
    std::cout << jsonText(statistics);
    return;
  }
  if (options.common.quiet) return;
  const Json& frame = statistics["frames"][0];
  std::cout << fmt::format(
      "{}: {} x {}, level {}, {} triangles drawn of {}, {:.1f} ms\n", options.output,
      view.render.camera.width, view.render.camera.height, frame["level"].get<int>(),
      frame["triangles"]["drawn"].get<std::uint64_t>(), frame["triangles"]["in"].get<std::uint64_t>(),
      frame["frame_ms"]["median"].is_null() ? 0.0 : frame["frame_ms"]["median"].get<double>());
  if (!options.common.verbose) return;
  const Camera& camera = view.render.camera;
  std::cout << fmt::format("  eye {:.6f},{:.6f},{:.1f} look {:.3f},{:.3f},{:.3f} fov {}\n",
                           camera.eye.latitude, camera.eye.longitude, camera.eye.height, camera.heading,
                           camera.pitch, camera.roll, camera.field_of_view);
}

Result<int> run(const ViewOptions& options) {
  DELTAZ_TRY_ASSIGN(View view, parseView(options));
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), options.area));
  DELTAZ_TRY_ASSIGN(view.render.camera, placeCamera(database, view.camera));
  DELTAZ_TRY(checkScene(database, options.scene, view.render));
  DELTAZ_TRY_ASSIGN(const Frame frame, renderFrame(database, view, options.common));

  const Json statistics = statisticsJson(options.area, view, frame.repeats);
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> png, encodePng(frame.picture));
  std::vector<std::byte> depth;
  if (!options.depth_path.empty()) {
    DELTAZ_TRY_ASSIGN(depth, encodeDepthTiff(frame.picture, depthDescription(database, view.render.camera)));
  }
  std::vector<std::byte> stream;
  if (!view.record_path.empty()) {
    DELTAZ_TRY_ASSIGN(stream, ars::encodeTriangleStream(frame.recorded));
  }
  // The picture comes last: where it stands, everything asked for does.
  const bool overwrite = options.common.overwrite;
  if (!view.record_path.empty()) DELTAZ_TRY(writeOutput(view.record_path, stream, overwrite));
  if (!options.depth_path.empty()) DELTAZ_TRY(writeOutput(options.depth_path, depth, overwrite));
  if (!options.statistics_path.empty())
    DELTAZ_TRY(writeOutput(options.statistics_path, jsonText(statistics), overwrite));
  DELTAZ_TRY(writeOutput(options.output, png, overwrite));
  printSummary(options, view, statistics);
  return kExitDone;
}

}  // namespace

}  // namespace deltaz

int main(int argc, char** argv) {
  using namespace deltaz;
  return runTool("dbview", [&]() -> Result<int> {
    CLI::App app("Draws a terrain database from a viewpoint.", "dbview");
    // A subcommand is known by the first word, so that drawing, the tool's main purpose, needs none.
    if (argc > 1 && std::string_view(argv[1]) == "sweep") {
      SweepOptions options;
      app.set_help_flag("-h,--help", "Print this help and exit");
      CLI::App& command =
          *app.add_subcommand("sweep", "Measures run time against error, for a database and views.");
      addSweepOptions(command, options);
      if (const auto code = parseCommandLine(app, "dbview", argc, argv)) return *code;
      return runSweep(options);
    }
    if (argc > 1 && std::string_view(argv[1]) == "ars-report") {
      ArsReportOptions options;
      app.set_help_flag("-h,--help", "Print this help and exit");
      CLI::App& command = *app.add_subcommand(
          "ars-report", "Makes the experiments of the 1983 report again, ours beside the published figures.");
      addArsReportOptions(command, options);
      if (const auto code = parseCommandLine(app, "dbview", argc, argv)) return *code;
      return runArsReport(options);
    }
    if (argc > 1 && std::string_view(argv[1]) == "ars-sweep") {
      ArsSweepOptions options;
      app.set_help_flag("-h,--help", "Print this help and exit");
      CLI::App& command = *app.add_subcommand(
          "ars-sweep", "Plays a recorded stream on machines of 1983 that differ in one setting.");
      addArsSweepOptions(command, options);
      if (const auto code = parseCommandLine(app, "dbview", argc, argv)) return *code;
      return runArsSweep(options);
    }
    ViewOptions options;
    addViewOptions(app, options);
    if (const auto code = parseCommandLine(app, "dbview", argc, argv)) return *code;
    return run(options);
  });
}
