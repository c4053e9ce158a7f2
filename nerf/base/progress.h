#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace nerf {

// A progress line on standard error: title, bar, count, time left, and a note. Drawn only on a
// terminal, at most ten times a second.
class ProgressLine {
 public:
  //   total  number of steps; 0 where it is unknown, then no bar and no time left are shown
  //   start  number of steps done before
  ProgressLine(std::string title, std::int64_t total, std::int64_t start = 0);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  //   done  steps done so far
  //   note  shown at the end of the line
  void Update(std::int64_t done, const std::string& note = {});
  // Clears the line, so that other output can follow. Called by the destructor too.
  void Finish();

  static bool IsTerminal();

 private:
  using Clock = std::chrono::steady_clock;
  std::string title_;
  std::int64_t total_;
  std::int64_t start_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_{};
  bool visible_ = false;
};

// "1:05:09", "2:03", "0:07".
std::string FormatDuration(double seconds);

// "0.4 s", "40 s", "2:03"; "forever" for infinity.
std::string FormatSeconds(double seconds);

}  // namespace nerf
