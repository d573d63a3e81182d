// dbview ars-report: the experiments of the 1983 report made again on the machine's model, ours beside the
// published figures. See dbview(1), THE MACHINE OF 1983.
#pragma once

#include <string>
#include <vector>

#include "tools/common/command_line.h"

namespace deltaz {

struct ArsReportOptions {
  CommonOptions common;
  std::string triangles = "2000";
  std::vector<std::string> reports;
};

void addArsReportOptions(CLI::App& app, ArsReportOptions& options);

// The exit code. Errors: kUsage, kCannotAccess (a report cannot be written).
Result<int> runArsReport(const ArsReportOptions& options);

}  // namespace deltaz
