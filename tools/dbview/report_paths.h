// Where a command's report goes beside the screen: --report json=FILE,svg=FILE.
#pragma once

#include <string>
#include <vector>

#include "tools/common/command_line.h"

namespace deltaz {

struct ReportPaths {
  std::string json, svg;  // empty: not asked for
};

void addReportOption(CLI::App& app, std::vector<std::string>& reports);

// Errors: kUsage (no such form, one twice, a file that stands there already), kCannotAccess.
Result<ReportPaths> parseReportPaths(const std::vector<std::string>& reports, bool overwrite);

}  // namespace deltaz
