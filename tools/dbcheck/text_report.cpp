#include "tools/dbcheck/text_report.h"

#include <algorithm>
#include <fmt/format.h>

#include "libdb/check/code_registry.h"

namespace deltaz {

namespace {

std::string plural(std::uint64_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// "3 errors, 1 warning"
std::string countsText(const Report& report) {
  std::string text;
  for (const auto& [severity, noun] :
       {std::pair{Severity::kError, "error"}, std::pair{Severity::kWarning, "warning"}}) {
    const std::uint64_t count = report.count(severity);
    if (count == 0) continue;
    text += (text.empty() ? "" : ", ") + plural(count, noun);
  }
  return text;
}

// "terrain-000001.dzt, block 7, node 12 (level 0, x 3, y 4), lon -121.76, lat 46.85"
std::string placeText(const IssueLocation& where) {
  std::string text = where.file;
  const auto append = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (where.block) append(fmt::format("block {}", *where.block));
  if (where.offset) append(fmt::format("byte {}", *where.offset));
  if (where.node) append(fmt::format("node {}", *where.node));
  if (where.level) append(fmt::format("level {}", *where.level));
  if (where.x && where.y) append(fmt::format("tile {},{}", *where.x, *where.y));
  // Seven digits are a centimetre on the ground.
  if (where.longitude && where.latitude)
    append(fmt::format("lon {:.7f}, lat {:.7f}", *where.longitude, *where.latitude));
  return text;
}

std::string issueText(const Issue& issue) {
  const std::string place = placeText(issue.where);
  return place.empty() ? issue.message : place + ": " + issue.message;
}

std::string groupText(const IssueGroup& group, std::size_t shown_locations) {
  std::string text = fmt::format("  {} {} ({}): {}\n", severityName(group.severity),
                                 issueCodeName(group.code), group.count, describe(group.code).title);
  const std::size_t shown = std::min(shown_locations, group.first.size());
  for (std::size_t i = 0; i < shown; ++i) text += "    " + issueText(group.first[i]) + "\n";
  if (group.count > shown) text += fmt::format("    and {} more\n", group.count - shown);
  if (group.worst && group.count > 1) text += "    worst: " + issueText(*group.worst) + "\n";
  return text;
}

std::string verdictLine(const Report& report, const Judgement& judgement) {
  const std::string counts = countsText(report);
  switch (judgement.verdict) {
    case Verdict::kValid:
      return counts.empty() ? "valid" : "valid: " + counts;
    case Verdict::kInvalid:
      return counts.empty() ? "invalid" : "invalid: " + counts;
    case Verdict::kUnknown:
      break;
  }
  return report.fatal ? "unknown: it could not be checked" : "unknown: not every check ran to its end";
}

}  // namespace

std::string textReport(const Report& report, const CheckRequest& request, const Judgement& judgement,
                       std::size_t shown_locations) {
  std::string text = fmt::format("{}: {}\n", request.area, verdictLine(report, judgement));
  text += fmt::format("  level {}: {}, {}, {} checked\n", levelName(request.level),
                      plural(report.nodes_checked, "node"), plural(report.blocks_checked, "block"),
                      plural(report.bytes_checked, "byte"));
  if (request.level >= CheckLevel::kGeometry) {
    const std::string sample =
        request.sample_percent < 100 ? fmt::format(" (--sample {})", request.sample_percent) : "";
    text += fmt::format("  errors recomputed over {}{}\n",
                        report.leaves_measured == 1 ? std::string("1 leaf")
                                                    : fmt::format("{} leaves", report.leaves_measured),
                        sample);
  }
  if (!request.against.empty()) {
    text += fmt::format("  against {}: {} compared\n", fmt::join(request.against, ", "),
                        plural(report.posts_compared, "post"));
  }
  for (const std::string& reason : report.skipped) text += "  not checked: " + reason + "\n";
  for (const std::string& note : report.notes) text += "  note: " + note + "\n";
  for (const IssueGroup& group : report.groups) text += groupText(group, shown_locations);
  return text;
}

}  // namespace deltaz
