#include "tools/dbview/options.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "formats/file_system.h"
#include "libdb/access/simd_target.h"
#include "librender/antialias/sample_grid.h"
#include "tools/common/output_file.h"
#include "tools/common/parse.h"

namespace deltaz {

namespace {

constexpr double kLargestTolerance = 1e6;  // pixels
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
  const std::array paths = {options.output, options.depth_path, options.statistics_path, options.record};
  for (std::size_t a = 0; a < paths.size(); ++a) {
    for (std::size_t b = a + 1; b < paths.size(); ++b) {
      if (same(paths[a], paths[b]))
        return usageError(paths[a], "two results would go into one file", {}, "Give each a name of its own");
    }
  }
  for (const std::string& path : paths) {
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
  addSceneOptions(app, options.scene);
  app.add_option("--tolerance", options.tolerance,
                 "Largest error on the screen, pixels; 0 draws full resolution (default: 1)")
      ->type_name("PX");
  app.add_option("--samples", options.samples,
                 "Samples a pixel, against jagged edges: 1, 4, 16 or 64 (default: 1)")
      ->type_name("N");
  addSamplingOptions(app, options.sampling);
  app.add_option(
         "--lod", options.lod,
         "How coarse the terrain may be: error, within --tolerance, or report, by range as in 1983: no "
         "error is bounded, and there are cracks (default: error)")
      ->check(CLI::IsMember({"error", "report"}))
      ->type_name("SCHEME");
  app.add_option(
         "--transform", options.transform,
         "How terrain posts are placed: exact, on the curved Earth; local, in single precision around "
         "each node; delta, the sums of 1983; matrix, a flat node. All but exact leave cracks "
         "(default: exact)")
      ->check(CLI::IsMember({"exact", "local", "delta", "matrix"}))
      ->type_name("TRANSFORM");
  app.add_option("--engine", options.engine,
                 "fast; reference: double precision, every triangle; or ars: the machine of 1983, with its "
                 "clocks (default: fast)")
      ->check(CLI::IsMember({"fast", "reference", "ars"}))
      ->type_name("ENGINE");
  app.add_option("--ars", options.ars,
                 "How the machine of --engine ars is built, e.g. tilers=2,mode=sequential; see dbview(1)")
      ->type_name("KEY=VALUE,...");
  addPathOption(
      app, "--record", options.record,
      "With --engine ars: write the triangles the machine is sent, to be played by dbview ars-sweep")
      ->type_name("FILE.ars");
  app.add_option(
         "--simd", options.simd,
         "Widest vector instructions to use: auto, portable, sse4, avx2 or avx512. The picture is the same "
         "on all of them (default: auto)")
      ->check(CLI::IsMember({"auto", "portable", "sse4", "avx2", "avx512"}))
      ->type_name("SET");
  addPathOption(app, "--stats", options.statistics_path, "Write statistics of the frame as JSON")
      ->type_name("FILE.json");
  addPathOption(app, "--depth", options.depth_path,
                "Write depth as a TIFF of 32-bit floats: metres along the view axis")
      ->type_name("FILE.tif");
  app.add_option("--repeat", options.repeat, "Render this many times, for the times in --stats (default: 1)")
      ->type_name("N");
  addCommonOptions(app, options.common, true);
  app.footer(
      "'dbview sweep AREA.dz' measures run time against error; see 'dbview sweep --help'.\n"
      "Exit codes: 0 done; 1 damaged or not a database; 2 usage, target exists; 3 cannot read or write; 4 "
      "newer format;\n"
      "70 internal error. See dbview(1).");
}

Result<View> parseView(const ViewOptions& options) {
  View view;
  DELTAZ_TRY_ASSIGN(view.camera, parseCamera(options.scene.camera));
  DELTAZ_TRY_ASSIGN(const double tolerance,
                    parseNumberBetween(options.tolerance, "--tolerance", 0, kLargestTolerance));
  DELTAZ_TRY_ASSIGN(const int samples, parseSampleCount(options.samples, "--samples"));
  const LodScheme lod = options.lod == "report" ? LodScheme::kReport : LodScheme::kError;
  DELTAZ_TRY_ASSIGN(const std::int64_t repeat, parseInteger(options.repeat, "--repeat", 1, kLargestRepeat));
  view.repeat = static_cast<int>(repeat);
  view.engine = options.engine == "reference" ? EngineKind::kReference
                : options.engine == "ars"     ? EngineKind::kArs
                                              : EngineKind::kFast;
  if (view.engine == EngineKind::kReference && lod == LodScheme::kReport) {
    return usageError("--lod", "the reference engine draws every triangle, there are no levels to choose", {},
                      "Leave out --lod report, or --engine reference");
  }
  const auto transform =
      std::find_if(kTransformKinds.begin(), kTransformKinds.end(),
                   [&](TransformKind kind) { return transformName(kind) == options.transform; });
  if (view.engine == EngineKind::kReference && *transform != TransformKind::kExact) {
    return usageError("--transform", "the reference engine is always exact", {},
                      fmt::format("Leave out --transform {}, or --engine reference", options.transform));
  }
  if (options.simd != "auto" && !limitSimdTarget(simdTargetNamed(options.simd))) {
    return usageError("--simd", fmt::format("this processor has no {}", options.simd), {},
                      "Leave out --simd");
  }
  if (view.engine != EngineKind::kArs) {
    for (const auto& [name, value] :
         {std::pair("--ars", options.ars), std::pair("--record", options.record)}) {
      if (!value.empty())
        return usageError(name, "only the machine of 1983 has this", {},
                          "Give --engine ars, or leave it out");
    }
  }
  DELTAZ_TRY_ASSIGN(const ArsOptions ars, parseArsOptions(options.ars));
  DELTAZ_TRY(checkOutputs(options));
  DELTAZ_TRY_ASSIGN(RenderOptions render, parseScene(options.scene, options.common));
  render.tolerance = tolerance;
  render.sampling = parseSampling(options.sampling);
  render.sampling.count = samples;
  render.camera = view.camera.camera;
  DELTAZ_TRY(checkSampling(render));
  render.lod = lod;
  render.transform = *transform;
  render.ars = ars;
  view.record_path = options.record;
  view.render = std::move(render);
  return view;
}

const char* engineName(EngineKind kind) {
  switch (kind) {
    case EngineKind::kReference:
      return "reference";
    case EngineKind::kArs:
      return "ars";
    case EngineKind::kFast:
      break;
  }
  return "fast";
}

const char* lodName(LodScheme lod) {
  return lod == LodScheme::kReport ? "report" : "error";
}

}  // namespace deltaz
