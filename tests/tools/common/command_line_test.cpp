#include "tools/common/command_line.h"

#include <gtest/gtest.h>
#include <iostream>
#include <new>
#include <stdexcept>

namespace deltaz {
namespace {

// Runs a body and gives its exit code and what it said on stderr.
std::pair<int, std::string> outcome(const std::function<Result<int>()>& body) {
  testing::internal::CaptureStderr();
  const int code = runTool("tool", body);
  return {code, testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, each_kind_of_error_has_its_exit_code) {
  EXPECT_EQ(outcome([]() -> Result<int> { return kExitDone; }), std::pair(0, std::string()));
  const std::pair<ErrorKind, int> table[] = {{ErrorKind::kInvalid, 1},
                                             {ErrorKind::kUsage, 2},
                                             {ErrorKind::kCannotAccess, 3},
                                             {ErrorKind::kNewerFormat, 4},
                                             {ErrorKind::kInternal, 70}};
  for (const auto& [kind, code] : table) {
    const auto [found, text] = outcome([kind = kind]() -> Result<int> {
      return Error{kind, IssueCode::kNone, "what", "where", "why", "remedy"};
    });
    EXPECT_EQ(found, code);
    EXPECT_EQ(text, "tool: error: where: what: why. remedy\n");
  }
}

TEST(CommandLine, an_exception_nobody_caught_is_our_error) {
  const auto [code, text] = outcome([]() -> Result<int> { throw std::logic_error("lost"); });
  EXPECT_EQ(code, kExitInternal);
  EXPECT_EQ(text, "tool: error: internal error: lost\n");
  EXPECT_EQ(outcome([]() -> Result<int> { throw std::bad_alloc(); }).first, kExitInternal);
  EXPECT_EQ(outcome([]() -> Result<int> { throw 7; }).first, kExitInternal);
}

TEST(CommandLine, output_that_cannot_be_written_is_an_error) {
  const auto [code, text] = outcome([]() -> Result<int> {
    std::cout.setstate(std::ios::badbit);
    return kExitDone;
  });
  std::cout.clear();
  EXPECT_EQ(code, kExitCannotAccess);
  EXPECT_NE(text.find("standard output"), std::string::npos);
}

TEST(CommandLine, usage_errors_end_with_2_whatever_the_parser_thinks) {
  for (const char* word : {"--nonsense", "surplus", "-j"}) {
    CLI::App app("", "tool");
    CommonOptions options;
    addCommonOptions(app, options, true);
    std::string name = "tool", argument = word;
    char* arguments[] = {name.data(), argument.data()};
    testing::internal::CaptureStderr();
    EXPECT_EQ(parseCommandLine(app, "tool", 2, arguments), kExitUsage);
    EXPECT_NE(testing::internal::GetCapturedStderr().find(word), std::string::npos);
  }
}

TEST(CommandLine, thread_counts_are_positive) {
  CommonOptions options;
  EXPECT_EQ(options.threads().value(), 0);
  options.threads_text = "7";
  EXPECT_EQ(options.threads().value(), 7);
  for (const char* text : {"0", "-1", "two", "1025"}) {
    options.threads_text = text;
    EXPECT_FALSE(options.threads().ok()) << text;
  }
}

}  // namespace
}  // namespace deltaz
