#include "tools/dbcheck/verdict.h"

#include "tools/common/command_line.h"

namespace deltaz {

Judgement judge(const Report& report, Severity fail_on) {
  // A failure to read says nothing about the content, whatever issue stands for it in the list.
  if (report.fatal && report.fatal->kind != ErrorKind::kInvalid) {
    return {Verdict::kUnknown, exitCode(report.fatal->kind)};
  }
  std::uint64_t failing = report.count(Severity::kError);
  if (fail_on == Severity::kWarning) failing += report.count(Severity::kWarning);
  if (failing > 0 || report.fatal) return {Verdict::kInvalid, kExitInvalid};
  if (!report.complete) return {Verdict::kUnknown, kExitUnknown};
  return {Verdict::kValid, kExitDone};
}

const char* verdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kValid:
      return "valid";
    case Verdict::kInvalid:
      return "invalid";
    case Verdict::kUnknown:
      return "unknown";
  }
  return "unknown";
}

const char* severityName(Severity severity) {
  switch (severity) {
    case Severity::kInformation:
      return "information";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "error";
  }
  return "error";
}

const char* levelName(CheckLevel level) {
  switch (level) {
    case CheckLevel::kStructure:
      return "structure";
    case CheckLevel::kChecksum:
      return "checksum";
    case CheckLevel::kDecode:
      return "decode";
    case CheckLevel::kGeometry:
      return "geometry";
  }
  return "decode";
}

std::optional<CheckLevel> levelFromName(const std::string& name) {
  if (name == "all") return kDeepestLevel;
  for (const CheckLevel level :
       {CheckLevel::kStructure, CheckLevel::kChecksum, CheckLevel::kDecode, CheckLevel::kGeometry}) {
    if (name == levelName(level)) return level;
  }
  return std::nullopt;
}

}  // namespace deltaz
