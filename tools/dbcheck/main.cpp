// dbcheck: proves a database right or says exactly what is wrong with it. See dbcheck(1).
#include <fmt/format.h>
#include <iostream>
#include <vector>

#include "libdb/check/check.h"
#include "tools/common/command_line.h"
#include "tools/common/output_file.h"
#include "tools/common/progress.h"
#include "tools/dbcheck/against_sources.h"
#include "tools/dbcheck/code_listing.h"
#include "tools/dbcheck/json_report.h"
#include "tools/dbcheck/text_report.h"

namespace deltaz {

namespace {

constexpr std::size_t kShownLocations = 3;

struct Options {
  CommonOptions common;
  std::string area;
  std::string level = "decode";
  double sample = 100;
  std::vector<std::string> against;
  std::string crs;
  std::vector<std::string> reports;
  std::string fail_on = "error";
  bool list_codes = false;
  std::string explain;
};

void addOptions(CLI::App& app, Options& options) {
  addPathOption(app, "AREA.dz", options.area, "The database");
  app.add_option("--level", options.level,
                 "How deep to look, each level with those before it: structure, checksum, decode, geometry; "
                 "all is every level this version has (default: decode)")
      ->type_name("LEVEL");
  app.add_option("--sample", options.sample,
                 "At level geometry recompute the errors of this part of the leaves only, always the same "
                 "ones; the report says how many (default: 100)")
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("PERCENT");
  app.add_option("--against", options.against,
                 "The DEMs the database was built from: compare post for post, read as the database says it "
                 "read them")
      ->type_name("DEM...");
  app.add_option("--crs", options.crs, "CRS of those DEMs where they name none")->type_name("CRS");
  app.add_option("--report", options.reports,
                 "Also write the report to a file; the form of this version is json")
      ->type_name("json=FILE")
      ->delimiter(',');
  app.add_option("--fail-on", options.fail_on,
                 "Least severity that makes a database invalid: error or warning (default: error)")
      ->check(CLI::IsMember({"error", "warning"}))
      ->type_name("SEVERITY");
  app.add_flag("--list-codes", options.list_codes, "List every issue code and exit");
  app.add_option("--explain", options.explain, "Explain an issue code and exit")->type_name("CODE");
  addCommonOptions(app, options.common, true);
  app.footer(
      "Exit codes: 0 valid; 1 invalid; 2 usage; 3 cannot read; 4 verdict unknown or newer format; 70 "
      "internal error.\n"
      "See dbcheck(1).");
}

// Paths of the reports to write. The word before '=' is the form.
Result<std::vector<std::string>> reportPaths(const Options& options) {
  constexpr std::string_view kForm = "json=";
  std::vector<std::string> paths;
  for (const std::string& report : options.reports) {
    if (!report.starts_with(kForm)) {
      return usageError("--report", fmt::format("'{}' is not json=FILE", report), {},
                        "json is the one form this version writes");
    }
    paths.push_back(report.substr(kForm.size()));
    if (paths.back().empty()) return usageError("--report", "the name after json= is empty");
    DELTAZ_TRY(checkOutput(paths.back(), options.common.overwrite));
  }
  return paths;
}

Result<CheckRequest> makeRequest(const Options& options) {
  if (options.area.empty()) {
    return usageError("AREA.dz", "no database is given",
                      options.against.empty() ? "" : "what follows --against are DEMs",
                      options.against.empty() ? "See 'dbcheck --help'" : "Name the database first");
  }
  CheckRequest request;
  request.area = options.area;
  const std::optional<CheckLevel> level = levelFromName(options.level);
  if (!level) {
    return usageError("--level", fmt::format("'{}' is not a level of this version", options.level), {},
                      "There are structure, checksum, decode, geometry and all");
  }
  request.level = *level;
  request.sample_percent = options.sample;
  if (options.sample < 100 && *level < CheckLevel::kGeometry)
    return usageError("--sample", "it means nothing below --level geometry");
  request.fail_on = options.fail_on == "warning" ? Severity::kWarning : Severity::kError;
  request.against = options.against;
  if (!options.crs.empty() && request.against.empty())
    return usageError("--crs", "it means nothing without --against");
  return request;
}

Result<int> listCodes(const Options& options) {
  if (!options.explain.empty()) {
    if (options.common.json) {
      DELTAZ_TRY_ASSIGN(const Json json, explainCodeJson(options.explain));
      std::cout << jsonText(json);
    } else {
      DELTAZ_TRY_ASSIGN(const std::string text, explainCode(options.explain));
      std::cout << text;
    }
  } else {
    std::cout << (options.common.json ? jsonText(codeTableJson()) : codeTable());
  }
  return kExitDone;
}

Result<int> check(const Options& options) {
  DELTAZ_TRY_ASSIGN(const CheckRequest request, makeRequest(options));
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> report_paths, reportPaths(options));
  CheckOptions check_options;
  check_options.level = request.level;
  check_options.sample_percent = request.sample_percent;
  DELTAZ_TRY_ASSIGN(check_options.threads, options.common.threads());

  Report report;
  {
    ProgressReporter progress(progressMode(options.common), "dbcheck", std::cerr);
    progress.report("reading", 0);
    SourceArea sources;
    if (!request.against.empty()) {
      DELTAZ_TRY_ASSIGN(sources, readAgainst(options.against, options.crs, request.area));
      check_options.against = sources.grids.data();
      check_options.against_count = sources.grids.size();
      check_options.against_name = fmt::format("{}", fmt::join(request.against, ", "));
    }
    progress.report("checking", 0.1);
    report = checkDatabase(localFileSystem(), request.area, check_options);
    progress.report("done", 1);
  }

  const Judgement judgement = judge(report, request.fail_on);
  const std::string json = jsonText(jsonReport(report, request, judgement));
  for (const std::string& path : report_paths) DELTAZ_TRY(writeOutput(path, json, options.common.overwrite));
  if (options.common.json) {
    std::cout << json;
  } else if (!options.common.quiet) {
    std::cout << textReport(report, request, judgement,
                            options.common.verbose ? kKeptIssues : kShownLocations);
  }
  if (report.fatal) {
    std::cout.flush();
    printError("dbcheck", *report.fatal);
  } else if (judgement.verdict == Verdict::kUnknown) {
    std::cout.flush();
    Error unknown;
    unknown.where = request.area;
    unknown.what = "the verdict is unknown";
    unknown.why = "not everything was checked";
    if (!report.skipped.empty()) unknown.why += ": " + report.skipped.front();
    if (!request.against.empty())
      unknown.remedy = "Name all sources behind --against, if some are missing there";
    printError("dbcheck", unknown);
  }
  return judgement.exit_code;
}

}  // namespace

}  // namespace deltaz

int main(int argc, char** argv) {
  using namespace deltaz;
  return runTool("dbcheck", [&]() -> Result<int> {
    CLI::App app("Proves a terrain database right, or says exactly what is wrong with it.", "dbcheck");
    Options options;
    addOptions(app, options);
    if (const auto code = parseCommandLine(app, "dbcheck", argc, argv)) return *code;
    return options.list_codes || !options.explain.empty() ? listCodes(options) : check(options);
  });
}
