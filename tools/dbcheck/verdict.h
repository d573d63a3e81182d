// What a report amounts to. The verdict is made from the whole report, before anything is chosen for display.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libdb/check/check.h"

namespace deltaz {

enum class Verdict { kValid, kInvalid, kUnknown };

struct Judgement {
  Verdict verdict = Verdict::kUnknown;
  int exit_code = 4;
};

// Invalid if there is an issue of `fail_on` or worse; otherwise unknown if a check did not run to its end or
// the database could not be read (exit code 3) or is newer than this version (4); otherwise valid.
Judgement judge(const Report& report, Severity fail_on);

// The names used in text, JSON and options.
const char* verdictName(Verdict verdict);
const char* severityName(Severity severity);
const char* levelName(CheckLevel level);
// "structure", "checksum", "decode", "geometry", and "all" for every level there is; nothing for another
// word.
std::optional<CheckLevel> levelFromName(const std::string& name);

// What was asked for, and of what: the heading of both forms of the report.
struct CheckRequest {
  std::string area;                  // as given
  std::vector<std::string> against;  // paths; none without comparison
  CheckLevel level = CheckLevel::kDecode;
  Severity fail_on = Severity::kError;
  double sample_percent = 100;  // of leaves whose errors are recomputed
};

}  // namespace deltaz
