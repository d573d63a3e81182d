#include "tools/common/progress.h"

#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace deltaz {
namespace {

std::vector<double> fractionsOf(const std::string& text) {
  std::istringstream lines(text);
  std::vector<double> fractions;
  for (std::string line; std::getline(lines, line);)
    fractions.push_back(nlohmann::json::parse(line)["fraction"].get<double>());
  return fractions;
}

TEST(Progress, never_falls_and_never_exceeds_one) {
  std::ostringstream out;
  {
    ProgressReporter progress(ProgressMode::kJson, "tool", out);
    for (const double fraction :
         {0.0, 0.5, 0.2, std::numeric_limits<double>::quiet_NaN(), 0.7, 1.5, 0.1, 1.0}) {
      progress.report("phase " + std::to_string(fraction), fraction);
    }
  }
  const std::vector<double> fractions = fractionsOf(out.str());
  EXPECT_EQ(fractions, (std::vector<double>{0, 0.5, 0.5, 0.5, 0.7, 1, 1, 1}));
}

TEST(Progress, small_steps_of_one_phase_are_not_repeated) {
  std::ostringstream out;
  ProgressReporter progress(ProgressMode::kJson, "tool", out);
  for (int i = 0; i <= 100000; ++i) progress.report("building", i / 100000.0);
  EXPECT_EQ(fractionsOf(out.str()).size(), 101u);
}

TEST(Progress, a_terminal_has_one_line_that_is_cleared) {
  std::ostringstream out;
  {
    ProgressReporter progress(ProgressMode::kTerminal, "tool", out);
    progress.report("building", 0.25);
  }
  EXPECT_EQ(out.str(), "\r\033[Ktool: building  25 %\r\033[K");
}

TEST(Progress, where_nobody_watches_the_first_half_minute_is_silent) {
  std::ostringstream out;
  ProgressReporter progress(ProgressMode::kLines, "tool", out);
  progress.report("building", 0.25);
  EXPECT_EQ(out.str(), "");
}

TEST(Progress, quiet_and_none_say_nothing) {
  CommonOptions options;
  options.quiet = true;
  EXPECT_EQ(progressMode(options), ProgressMode::kNone);
  options.progress = "json";
  EXPECT_EQ(progressMode(options), ProgressMode::kJson);
  options = {};
  options.progress = "none";
  EXPECT_EQ(progressMode(options), ProgressMode::kNone);
}

}  // namespace
}  // namespace deltaz
