#include "tools/common/progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <ostream>
#include <unistd.h>

namespace deltaz {

namespace {

constexpr std::chrono::seconds kLineInterval{30};

// "12 s", "3 min", "2 h"
std::string durationText(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.0f} h", seconds / 3600);
}

}  // namespace

ProgressMode progressMode(const CommonOptions& options) {
  if (options.progress == "json") return ProgressMode::kJson;
  if (options.progress == "none" || options.quiet) return ProgressMode::kNone;
  return ::isatty(STDERR_FILENO) == 1 ? ProgressMode::kTerminal : ProgressMode::kLines;
}

ProgressReporter::ProgressReporter(ProgressMode mode, std::string tool, std::ostream& out)
    : mode_(mode), tool_(std::move(tool)), out_(out) {}

ProgressReporter::~ProgressReporter() {
  if (line_open_) out_ << "\r\033[K" << std::flush;
}

void ProgressReporter::report(std::string_view phase, double fraction) {
  if (mode_ == ProgressMode::kNone) return;
  const std::lock_guard lock(mutex_);
  if (std::isfinite(fraction)) fraction_ = std::clamp(fraction, fraction_, 1.0);
  const int percent = static_cast<int>(std::floor(fraction_ * 100));
  const bool news = percent > shown_percent_ || phase != phase_;
  phase_ = phase;
  if (!news) return;
  // Where nobody watches, a line now and then is enough.
  if (mode_ == ProgressMode::kLines && Clock::now() - shown_ < kLineInterval) return;
  shown_ = Clock::now();
  shown_percent_ = percent;
  print(phase);
}

void ProgressReporter::print(std::string_view phase) {
  if (mode_ == ProgressMode::kJson) {
    nlohmann::ordered_json line;
    line["phase"] = phase;
    line["fraction"] = fraction_;
    out_ << line.dump() + "\n" << std::flush;
    return;
  }
  const double seconds = std::chrono::duration<double>(shown_ - started_).count();
  std::string text = fmt::format("{}: {} {:3d} %", tool_, phase, shown_percent_);
  if (fraction_ > 0.02 && fraction_ < 1 && seconds > 2) {
    text += fmt::format(", {} left", durationText(seconds * (1 - fraction_) / fraction_));
  }
  if (mode_ == ProgressMode::kTerminal) {
    out_ << "\r\033[K" << text << std::flush;
    line_open_ = true;
  } else {
    out_ << text + "\n" << std::flush;
  }
}

}  // namespace deltaz
