#include <algorithm>
#include <iterator>
#include <utility>

#include "libdb/check/check.h"
#include "libdb/check/code_registry.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

// The group of `code`, made where it belongs in the order of the codes.
IssueGroup& groupOf(Report& report, IssueCode code, Severity severity) {
  const auto place =
      std::lower_bound(report.groups.begin(), report.groups.end(), code,
                       [](const IssueGroup& group, IssueCode wanted) { return group.code < wanted; });
  if (place != report.groups.end() && place->code == code) return *place;
  IssueGroup group;
  group.code = code;
  group.severity = severity;
  return *report.groups.insert(place, std::move(group));
}

// The first of several equally bad ones stays, so that the order of merging parts does not matter.
void keepWorst(IssueGroup& group, const Issue& issue) {
  if (!issue.magnitude) return;
  if (!group.worst || *group.worst->magnitude < *issue.magnitude) group.worst = issue;
}

}  // namespace

void Report::add(Issue issue) {
  IssueGroup& group = groupOf(*this, issue.code, issue.severity);
  ++group.count;
  keepWorst(group, issue);
  if (group.first.size() < kKeptIssues) group.first.push_back(std::move(issue));
}

std::uint64_t Report::count(Severity severity) const {
  std::uint64_t sum = 0;
  for (const IssueGroup& group : groups) {
    if (group.severity == severity) sum += group.count;
  }
  return sum;
}

Issue makeIssue(IssueCode code, std::string message, IssueLocation where, std::optional<double> magnitude) {
  Issue issue;
  issue.code = code;
  issue.severity = describe(code).severity;
  issue.message = std::move(message);
  issue.where = std::move(where);
  issue.magnitude = magnitude;
  return issue;
}

void addError(Report& report, const Error& error, IssueLocation where) {
  if (error.kind != ErrorKind::kInvalid) {
    report.complete = false;
    if (!report.fatal) report.fatal = error;
  }
  if (error.code == IssueCode::kNone) {
    // Only our own mistakes and misuse come without a code; they must not pass for a valid database.
    report.complete = false;
    if (!report.fatal) report.fatal = internalError(error.where, error.what);
    return;
  }
  std::string message = error.what;
  if (!error.why.empty()) message += ": " + error.why;
  report.add(makeIssue(error.code, std::move(message), std::move(where)));
}

void addSkipped(Report& report, std::string what) {
  report.complete = false;
  report.skipped.push_back(std::move(what));
}

void mergeReport(Report& into, Report part) {
  for (IssueGroup& from : part.groups) {
    IssueGroup& group = groupOf(into, from.code, from.severity);
    group.count += from.count;
    if (from.worst) keepWorst(group, *from.worst);
    for (Issue& issue : from.first) {
      if (group.first.size() == kKeptIssues) break;
      group.first.push_back(std::move(issue));
    }
  }
  into.complete = into.complete && part.complete;
  std::move(part.skipped.begin(), part.skipped.end(), std::back_inserter(into.skipped));
  std::move(part.notes.begin(), part.notes.end(), std::back_inserter(into.notes));
  into.nodes_checked += part.nodes_checked;
  into.blocks_checked += part.blocks_checked;
  into.bytes_checked += part.bytes_checked;
  into.posts_compared += part.posts_compared;
  into.leaves_measured += part.leaves_measured;
  if (!into.fatal) into.fatal = std::move(part.fatal);
}

}  // namespace deltaz
