// Wall-clock milliseconds of the stages of a frame. Thread-safety: one thread.
#pragma once

#include <chrono>

namespace deltaz {

class Stopwatch {
 public:
  // Milliseconds since the last lap (or construction), and since construction.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double elapsed = milliseconds(now - lap_);
    lap_ = now;
    return elapsed;
  }
  double total() const { return milliseconds(Clock::now() - start_); }

 private:
  using Clock = std::chrono::steady_clock;
  static double milliseconds(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  }
  Clock::time_point start_ = Clock::now(), lap_ = start_;
};

}  // namespace deltaz
