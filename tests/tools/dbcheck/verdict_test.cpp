#include "tools/dbcheck/verdict.h"

#include <gtest/gtest.h>

namespace deltaz {
namespace {

Report reportWith(Severity severity) {
  Report report;
  report.add({IssueCode::kSumBlock, severity, "message", {}, std::nullopt});
  return report;
}

TEST(Verdict, no_issue_is_valid) {
  EXPECT_EQ(judge(Report{}, Severity::kError).exit_code, 0);
  EXPECT_EQ(judge(Report{}, Severity::kError).verdict, Verdict::kValid);
}

TEST(Verdict, issues_count_from_the_severity_asked_for) {
  EXPECT_EQ(judge(reportWith(Severity::kError), Severity::kError).exit_code, 1);
  EXPECT_EQ(judge(reportWith(Severity::kWarning), Severity::kError).exit_code, 0);
  EXPECT_EQ(judge(reportWith(Severity::kWarning), Severity::kWarning).exit_code, 1);
  EXPECT_EQ(judge(reportWith(Severity::kInformation), Severity::kWarning).exit_code, 0);
}

TEST(Verdict, what_did_not_run_to_its_end_is_unknown_unless_it_is_known_to_be_wrong) {
  Report report;
  report.complete = false;
  EXPECT_EQ(judge(report, Severity::kError).exit_code, 4);
  EXPECT_EQ(judge(report, Severity::kError).verdict, Verdict::kUnknown);
  report = reportWith(Severity::kError);
  report.complete = false;
  EXPECT_EQ(judge(report, Severity::kError).exit_code, 1);
}

TEST(Verdict, what_cannot_be_opened_ends_with_its_own_code) {
  Report report = reportWith(Severity::kError);
  report.fatal = accessError("area.dz", "cannot open");
  EXPECT_EQ(judge(report, Severity::kError).exit_code, 3);
  EXPECT_EQ(judge(report, Severity::kError).verdict, Verdict::kUnknown);
  report.fatal = newerFormatError(IssueCode::kHdrVersionNewer, "area.dz", "newer");
  EXPECT_EQ(judge(report, Severity::kError).exit_code, 4);
  report.fatal = invalidError(IssueCode::kManHash, "area.dz", "damaged");
  EXPECT_EQ(judge(report, Severity::kError).exit_code, 1);
  EXPECT_EQ(judge(report, Severity::kError).verdict, Verdict::kInvalid);
}

TEST(Verdict, levels_have_names) {
  EXPECT_EQ(levelFromName("all"), CheckLevel::kGeometry);
  EXPECT_EQ(levelFromName("structure"), CheckLevel::kStructure);
  EXPECT_EQ(levelFromName("geometry"), CheckLevel::kGeometry);
  EXPECT_EQ(levelFromName("depth"), std::nullopt);
}

}  // namespace
}  // namespace deltaz
