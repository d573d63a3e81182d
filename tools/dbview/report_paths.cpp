#include "tools/dbview/report_paths.h"

#include <fmt/format.h>

#include "tools/common/output_file.h"

namespace deltaz {

void addReportOption(CLI::App& app, std::vector<std::string>& reports) {
  app.add_option("--report", reports, "Also write the report to files; the forms are json and svg")
      ->type_name("json=FILE,svg=FILE")
      ->delimiter(',');
}

Result<ReportPaths> parseReportPaths(const std::vector<std::string>& reports, bool overwrite) {
  ReportPaths paths;
  for (const std::string& report : reports) {
    const bool json = report.starts_with("json=");
    if (!json && !report.starts_with("svg="))
      return usageError("--report", fmt::format("'{}' is neither json=FILE nor svg=FILE", report));
    std::string& path = json ? paths.json : paths.svg;
    if (!path.empty()) return usageError("--report", fmt::format("{} and {} are of one form", path, report));
    path = report.substr(report.find('=') + 1);
    if (path.empty()) return usageError("--report", fmt::format("the name after {} is empty", report));
    DELTAZ_TRY(checkOutput(path, overwrite));
  }
  if (!paths.json.empty() && paths.json == paths.svg) {
    return usageError(paths.json, "two results would go into one file", {}, "Give each a name of its own");
  }
  return paths;
}

}  // namespace deltaz
