#include "formats/error.h"

#include <gtest/gtest.h>
#include <set>

namespace deltaz {
namespace {

TEST(Error, message_says_where_what_why_and_remedy) {
  const Error error = usageError("area.dz", "the target exists", "it was built before", "Give --overwrite");
  EXPECT_EQ(error.message(), "area.dz: the target exists: it was built before. Give --overwrite");
  EXPECT_EQ(usageError("", "what").message(), "what");
}

TEST(Error, kinds_have_the_documented_exit_codes) {
  EXPECT_EQ(exitCode(ErrorKind::kInvalid), 1);
  EXPECT_EQ(exitCode(ErrorKind::kUsage), 2);
  EXPECT_EQ(exitCode(ErrorKind::kCannotAccess), 3);
  EXPECT_EQ(exitCode(ErrorKind::kNewerFormat), 4);
  EXPECT_EQ(exitCode(ErrorKind::kInternal), 70);
}

TEST(IssueCode, names_are_unique_and_lead_back_to_their_code) {
  std::set<std::string_view> names;
#define DELTAZ_CHECK(name, text)                       \
  EXPECT_EQ(issueCodeName(IssueCode::name), text);     \
  EXPECT_EQ(issueCodeFromName(text), IssueCode::name); \
  EXPECT_TRUE(names.insert(text).second) << text << " is used twice";
  DELTAZ_ISSUE_CODES(DELTAZ_CHECK)
#undef DELTAZ_CHECK
  EXPECT_FALSE(issueCodeFromName("NO_SUCH_CODE").has_value());
}

TEST(Result, try_returns_the_first_error) {
  const auto fails = []() -> Result<int> { return internalError("here", "broken"); };
  const auto calls = [&]() -> Status {
    DELTAZ_TRY_ASSIGN(const int value, fails());
    (void)value;
    ADD_FAILURE() << "went on after an error";
    return Success{};
  };
  const Status status = calls();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().what, "broken");
}

}  // namespace
}  // namespace deltaz
