// Says on stderr how far a long job is: a line that renews itself on a terminal, a line every half minute
// elsewhere, one JSON object a line for programs, or nothing. What is shown never falls and never exceeds 100
// %. Thread-safety: report may be called from any thread.
#pragma once

#include <chrono>
#include <iosfwd>
#include <mutex>
#include <string>
#include <string_view>

#include "tools/common/command_line.h"

namespace deltaz {

enum class ProgressMode { kNone, kTerminal, kLines, kJson };

// What `--progress auto|none|json` and -q mean for this process's stderr.
ProgressMode progressMode(const CommonOptions& options);

class ProgressReporter {
 public:
  ProgressReporter(ProgressMode mode, std::string tool, std::ostream& out);
  // Ends the line of a terminal.
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  // `fraction` is of the whole job, 0 .. 1; anything lower than before counts as before.
  void report(std::string_view phase, double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  void print(std::string_view phase);

  const ProgressMode mode_;
  const std::string tool_;
  std::ostream& out_;
  std::mutex mutex_;
  std::string phase_;
  double fraction_ = 0;
  int shown_percent_ = -1;
  bool line_open_ = false;
  Clock::time_point started_ = Clock::now();
  Clock::time_point shown_ = started_;
};

}  // namespace deltaz
