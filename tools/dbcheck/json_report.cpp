#include "tools/dbcheck/json_report.h"

#include "formats/file_system.h"
#include "libdb/check/code_registry.h"

namespace deltaz {

namespace {

const char* errorKindName(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalid:
      return "invalid";
    case ErrorKind::kUsage:
      return "usage";
    case ErrorKind::kCannotAccess:
      return "cannot_access";
    case ErrorKind::kNewerFormat:
      return "newer_format";
    case ErrorKind::kInternal:
      return "internal";
  }
  return "internal";
}

// Only the members that apply.
Json placeJson(const IssueLocation& where) {
  Json json = Json::object();
  if (!where.file.empty()) json["file"] = where.file;
  if (where.block) json["block"] = *where.block;
  if (where.offset) json["offset"] = *where.offset;
  if (where.node) json["node"] = *where.node;
  if (where.level) json["level"] = *where.level;
  if (where.x) json["x"] = *where.x;
  if (where.y) json["y"] = *where.y;
  if (where.longitude) json["longitude"] = finiteOrNull(*where.longitude);
  if (where.latitude) json["latitude"] = finiteOrNull(*where.latitude);
  return json;
}

Json issueJson(const Issue& issue) {
  Json json;
  json["message"] = issue.message;
  json["where"] = placeJson(issue.where);
  json["magnitude"] = issue.magnitude ? finiteOrNull(*issue.magnitude) : Json(nullptr);
  return json;
}

Json groupJson(const IssueGroup& group) {
  Json json;
  json["code"] = issueCodeName(group.code);
  json["severity"] = severityName(group.severity);
  json["title"] = describe(group.code).title;
  json["count"] = group.count;
  json["first"] = Json::array();
  for (const Issue& issue : group.first) json["first"].push_back(issueJson(issue));
  json["worst"] = group.worst ? issueJson(*group.worst) : Json(nullptr);
  return json;
}

}  // namespace

Json jsonReport(const Report& report, const CheckRequest& request, const Judgement& judgement) {
  Json json = jsonHeader("dbcheck");
  json["area"] = baseName(request.area);
  json["against"] = Json::array();
  for (const std::string& path : request.against) json["against"].push_back(baseName(path));
  json["level"] = levelName(request.level);
  json["sample_percent"] = request.sample_percent;
  json["fail_on"] = severityName(request.fail_on);
  json["verdict"] = verdictName(judgement.verdict);
  json["exit_code"] = judgement.exit_code;
  json["complete"] = report.complete;
  json["skipped"] = report.skipped;
  json["notes"] = report.notes;
  json["counts"] = {{"error", report.count(Severity::kError)},
                    {"warning", report.count(Severity::kWarning)},
                    {"information", report.count(Severity::kInformation)}};
  json["checked"] = {{"nodes", report.nodes_checked},
                     {"blocks", report.blocks_checked},
                     {"bytes", report.bytes_checked},
                     {"posts_compared", report.posts_compared},
                     {"leaves_measured", report.leaves_measured}};
  json["issues"] = Json::array();
  for (const IssueGroup& group : report.groups) json["issues"].push_back(groupJson(group));
  json["error"] = nullptr;
  if (report.fatal)
    json["error"] = {{"kind", errorKindName(report.fatal->kind)}, {"message", report.fatal->message()}};
  return json;
}

}  // namespace deltaz
