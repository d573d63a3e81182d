#include "tools/dbview/sweep_options.h"

#include <algorithm>
#include <fmt/format.h>

#include "formats/file_system.h"
#include "tools/common/parse.h"
#include "tools/dbview/report_paths.h"

namespace deltaz {

namespace {

constexpr double kLargestTolerance = 1e6;  // pixels
constexpr int kLargestRepeat = 10000;
constexpr std::size_t kMostValues = 64;  // of one knob

// The parts of a list "a,b,c".
Result<std::vector<std::string>> listOf(const std::string& text, const std::string& option) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back().push_back(c);
    }
  }
  if (parts.size() > kMostValues)
    return usageError(option, fmt::format("{} values are more than {}", parts.size(), kMostValues));
  return parts;
}

Error repeatedValue(const std::string& option, const std::string& value) {
  return usageError(option, fmt::format("{} stands there twice", value));
}

Result<std::vector<double>> parseTolerances(const std::string& text) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> parts, listOf(text, "--tolerances"));
  std::vector<double> values;
  for (const std::string& part : parts) {
    DELTAZ_TRY_ASSIGN(const double value, parseNumberBetween(part, "--tolerances", 0, kLargestTolerance));
    if (std::find(values.begin(), values.end(), value) != values.end())
      return repeatedValue("--tolerances", part);
    values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

Result<std::vector<Rational>> parseQuanta(const std::string& text) {
  if (text.empty()) return std::vector<Rational>{};
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> parts, listOf(text, "--quanta"));
  std::vector<Rational> values;
  for (const std::string& part : parts) {
    DELTAZ_TRY_ASSIGN(const Rational value, parseQuantum(part, "--quanta"));
    if (std::find(values.begin(), values.end(), value) != values.end())
      return repeatedValue("--quanta", part);
    values.push_back(value);
  }
  return values;
}

Result<std::vector<LodScheme>> parseLods(const std::string& text) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> parts, listOf(text, "--lods"));
  std::vector<LodScheme> values;
  for (const std::string& part : parts) {
    if (part != "error" && part != "report")
      return usageError("--lods", fmt::format("'{}' is neither error nor report", part));
    const LodScheme value = part == "report" ? LodScheme::kReport : LodScheme::kError;
    if (std::find(values.begin(), values.end(), value) != values.end()) return repeatedValue("--lods", part);
    values.push_back(value);
  }
  return values;
}

Result<std::vector<TransformKind>> parseTransforms(const std::string& text) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> parts, listOf(text, "--transforms"));
  std::vector<TransformKind> values;
  for (const std::string& part : parts) {
    const auto kind = std::find_if(kTransformKinds.begin(), kTransformKinds.end(),
                                   [&](TransformKind each) { return transformName(each) == part; });
    if (kind == kTransformKinds.end())
      return usageError("--transforms", fmt::format("'{}' is none of exact, local, delta, matrix", part));
    if (std::find(values.begin(), values.end(), *kind) != values.end())
      return repeatedValue("--transforms", part);
    values.push_back(*kind);
  }
  return values;
}

Result<std::vector<int>> parseSamples(const std::string& text) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> parts, listOf(text, "--samples"));
  std::vector<int> values;
  for (const std::string& part : parts) {
    DELTAZ_TRY_ASSIGN(const int value, parseSampleCount(part, "--samples"));
    if (std::find(values.begin(), values.end(), value) != values.end())
      return repeatedValue("--samples", part);
    values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

void addSweepOptions(CLI::App& app, SweepOptions& options) {
  addPathOption(app, "AREA.dz", options.area, "The database")->required();
  addSceneOptions(app, options.scene);
  addPathOption(app, "--views", options.views_path,
                "Draw the views of a file, see dbview(1). Without this and --eye: the whole area, eye level, "
                "oblique and zenith")
      ->type_name("FILE.json");
  app.add_option("--tolerances", options.tolerances,
                 "Largest errors on the screen to try, pixels; 0 is full resolution (default: "
                 "0.25,0.5,1,2,4)")
      ->type_name("PX,...");
  app.add_option("--quanta", options.quanta,
                 "Height steps to try beside the database's own, metres: for each a temporary copy is built")
      ->type_name("METRES,...");
  app.add_option("--lods", options.lods,
                 "Level of detail by error, or by range as in 1983, or both: error,report (default: error)")
      ->type_name("LOD,...");
  app.add_option("--transforms", options.transforms,
                 "Transforms of posts to try: exact,local,delta,matrix (default: exact)")
      ->type_name("TRANSFORM,...");
  app.add_option(
         "--samples", options.samples,
         "Samples a pixel to try: 1,4,16,64 (default: 1). With more than one the picture that colours "
         "are held against has 64, or as many as its size allows")
      ->type_name("N,...");
  addSamplingOptions(app, options.sampling);
  app.add_option("--reference", options.reference,
                 "Tolerance of the picture that colours are held against, pixels (default: 0, full "
                 "resolution)")
      ->type_name("PX");
  app.add_option("--repeat", options.repeat, "Frames to time of each setting in each view (default: 5)")
      ->type_name("N");
  addReportOption(app, options.reports);
  addCommonOptions(app, options.common, true);
  app.footer(
      "Exit codes: 0 done; 1 damaged or not a database; 2 usage, target exists; 3 cannot read or write; 4 "
      "newer format;\n"
      "70 internal error. See dbview(1).");
}

Result<SweepPlan> parseSweep(const SweepOptions& options) {
  SweepPlan plan;
  DELTAZ_TRY_ASSIGN(plan.camera, parseCamera(options.scene.camera));
  plan.views_of_area = options.views_path.empty() && plan.camera.whole_area;
  if (!options.views_path.empty() && !plan.camera.whole_area)
    return usageError("--views", "--views and --eye exclude each other");
  DELTAZ_TRY_ASSIGN(plan.tolerances, parseTolerances(options.tolerances));
  DELTAZ_TRY_ASSIGN(plan.lods, parseLods(options.lods));
  DELTAZ_TRY_ASSIGN(plan.transforms, parseTransforms(options.transforms));
  DELTAZ_TRY_ASSIGN(plan.samples, parseSamples(options.samples));
  DELTAZ_TRY_ASSIGN(plan.quanta, parseQuanta(options.quanta));
  DELTAZ_TRY_ASSIGN(plan.reference_tolerance,
                    parseNumberBetween(options.reference, "--reference", 0, kLargestTolerance));
  DELTAZ_TRY_ASSIGN(const std::int64_t repeats, parseInteger(options.repeat, "--repeat", 1, kLargestRepeat));
  plan.repeats = static_cast<int>(repeats);
  DELTAZ_TRY_ASSIGN(const ReportPaths paths, parseReportPaths(options.reports, options.common.overwrite));
  plan.json_path = paths.json;
  plan.svg_path = paths.svg;
  DELTAZ_TRY_ASSIGN(plan.render, parseScene(options.scene, options.common));
  plan.render.sampling = parseSampling(options.sampling);
  if (!options.views_path.empty()) {
    DELTAZ_TRY_ASSIGN(plan.views, readViewsFile(options.views_path, options.scene.camera));
  }
  return plan;
}

}  // namespace deltaz
