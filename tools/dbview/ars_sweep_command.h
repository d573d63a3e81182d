// dbview ars-sweep: a recorded stream played on machines that differ in one setting. See dbview(1), THE
// MACHINE OF 1983.
#pragma once

#include <string>
#include <vector>

#include "tools/common/command_line.h"

namespace deltaz {

struct ArsSweepOptions {
  CommonOptions common;
  std::string stream, key, values, ars, against;
  std::vector<std::string> reports;
};

void addArsSweepOptions(CLI::App& app, ArsSweepOptions& options);

// The exit code. Errors: kUsage, kCannotAccess, kInvalid (the stream).
Result<int> runArsSweep(const ArsSweepOptions& options);

}  // namespace deltaz
