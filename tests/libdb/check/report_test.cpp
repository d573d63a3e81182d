#include <gtest/gtest.h>

#include "libdb/check/check.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

Issue heightIssue(double magnitude) {
  return makeIssue(IssueCode::kSrcHeight, "differs", {}, magnitude);
}

TEST(Report, keeps_the_first_issues_and_counts_all) {
  Report report;
  for (int i = 0; i < 1000; ++i) report.add(heightIssue(i));
  ASSERT_EQ(report.groups.size(), 1u);
  EXPECT_EQ(report.groups[0].count, 1000u);
  ASSERT_EQ(report.groups[0].first.size(), kKeptIssues);
  EXPECT_EQ(report.groups[0].first.back().magnitude, static_cast<double>(kKeptIssues - 1));
  EXPECT_EQ(report.groups[0].worst->magnitude, 999.0);
  EXPECT_EQ(report.count(Severity::kError), 1000u);
  EXPECT_EQ(report.count(Severity::kWarning), 0u);
}

TEST(Report, groups_stand_in_the_order_of_the_codes) {
  Report report;
  report.add(heightIssue(1));
  report.add(makeIssue(IssueCode::kHdrMagic, "first"));
  report.add(makeIssue(IssueCode::kRefChild, "second"));
  ASSERT_EQ(report.groups.size(), 3u);
  EXPECT_EQ(report.groups[0].code, IssueCode::kHdrMagic);
  EXPECT_EQ(report.groups[1].code, IssueCode::kRefChild);
  EXPECT_EQ(report.groups[2].code, IssueCode::kSrcHeight);
}

TEST(Report, merging_parts_equals_adding_in_order) {
  Report whole, merged;
  for (int part = 0; part < 7; ++part) {
    Report piece;
    for (int i = 0; i < 5; ++i) {
      const double magnitude = (part * 5 + i) * 7 % 11;
      whole.add(heightIssue(magnitude));
      piece.add(heightIssue(magnitude));
    }
    mergeReport(merged, piece);
  }
  ASSERT_EQ(merged.groups.size(), 1u);
  EXPECT_EQ(merged.groups[0].count, whole.groups[0].count);
  EXPECT_EQ(merged.groups[0].worst->magnitude, whole.groups[0].worst->magnitude);
  for (std::size_t i = 0; i < kKeptIssues; ++i) {
    EXPECT_EQ(merged.groups[0].first[i].magnitude, whole.groups[0].first[i].magnitude);
  }
}

TEST(Report, lazy_issues_are_made_only_when_kept) {
  Report report;
  int made = 0;
  for (int i = 0; i < 1000; ++i) {
    addLazily(report, IssueCode::kHgtRing, 1.0, [&] {
      ++made;
      return makeIssue(IssueCode::kHgtRing, "differs", {}, 1.0);
    });
  }
  EXPECT_EQ(report.groups[0].count, 1000u);
  EXPECT_EQ(made, static_cast<int>(kKeptIssues));
}

TEST(Report, failure_without_a_code_is_never_a_clean_report) {
  Report report;
  addError(report, internalError("here", "what should not happen"));
  EXPECT_FALSE(report.complete);
  ASSERT_TRUE(report.fatal.has_value());
  EXPECT_EQ(report.fatal->kind, ErrorKind::kInternal);
}

}  // namespace
}  // namespace deltaz
