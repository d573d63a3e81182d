// What the rules write their findings with. Internal to libdb/check.
#pragma once

#include <optional>
#include <string>

#include "formats/error.h"
#include "libdb/check/check.h"

namespace deltaz {

// An issue with the severity its code has.
Issue makeIssue(IssueCode code, std::string message, IssueLocation where = {},
                std::optional<double> magnitude = std::nullopt);

// Reports a failure of reading under the code it carries. What keeps the check from going on (a newer format,
// an I/O error, a mistake of ours) also becomes the report's fatal error.
void addError(Report& report, const Error& error, IssueLocation where = {});

// Notes that something asked for was not checked.
void addSkipped(Report& report, std::string what);

// Appends `part`, whose findings come after those of `into`.
void mergeReport(Report& into, Report part);

// Counts an issue, and makes its text only if it will be kept: a rule may find millions.
template <typename MakeIssue>
void addLazily(Report& report, IssueCode code, double magnitude, MakeIssue make) {
  for (IssueGroup& group : report.groups) {
    if (group.code != code || group.first.size() < kKeptIssues) continue;
    if (group.worst && group.worst->magnitude && *group.worst->magnitude >= magnitude) {
      ++group.count;
      return;
    }
  }
  report.add(make());
}

}  // namespace deltaz
