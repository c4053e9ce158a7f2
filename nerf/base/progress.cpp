#include "nerf/base/progress.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace nerf {

std::string FormatDuration(double seconds) {
  const auto s = static_cast<std::int64_t>(std::max(0.0, seconds) + 0.5);
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string FormatSeconds(double seconds) {
  if (seconds > 1e7) return "forever";
  if (seconds >= 99.5) return FormatDuration(seconds);
  return fmt::format("{:.{}f} s", seconds, seconds < 9.95 ? 1 : 0);
}

bool ProgressLine::IsTerminal() { return isatty(STDERR_FILENO) == 1; }

ProgressLine::ProgressLine(std::string title, std::int64_t total, std::int64_t start)
    : title_(std::move(title)), total_(total), start_(start) {}

ProgressLine::~ProgressLine() { Finish(); }

void ProgressLine::Update(std::int64_t done, const std::string& note) {
  if (!IsTerminal()) return;
  const auto now = Clock::now();
  if (visible_ && now - drawn_ < std::chrono::milliseconds(100) && done != total_) return;
  drawn_ = now;
  visible_ = true;
  std::string line = title_;
  if (total_ > 0) {
    constexpr int kBarWidth = 24;
    const double fraction =
        std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
    const int filled = static_cast<int>(fraction * kBarWidth);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    line +=
        fmt::format(" [{:=<{}}{: <{}}] {}/{}", "", filled, "", kBarWidth - filled, done, total_);
    if (done > start_) {
      const double left =
          elapsed * static_cast<double>(total_ - done) / static_cast<double>(done - start_);
      line += fmt::format("  {} left", FormatDuration(left));
    }
  } else {
    line += fmt::format(" {}", done);
  }
  if (!note.empty()) line += "  " + note;
  std::fprintf(stderr, "\r\x1b[2K%s", line.c_str());
  std::fflush(stderr);
}

void ProgressLine::Finish() {
  if (!visible_) return;
  std::fprintf(stderr, "\r\x1b[2K");
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace nerf
