#include "client/command/progress.h"

#include <unistd.h>
#include <cmath>

#include <algorithm>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace homing::client {
namespace {

constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(std::string title, std::int64_t total, bool wanted)
    : title_(std::move(title)), total_(total), visible_(wanted && ::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (!visible_ || drawn_ == std::chrono::steady_clock::time_point{}) return;
  Draw();
  std::fputc('\n', stderr);
}

void Progress::Set(std::int64_t done) {
  const auto now = std::chrono::steady_clock::now();
  // Items that were done before this run do not count for the rate.
  if (first_ < 0) {
    first_ = done;
    begun_ = now;
  }
  done_ = done;
  if (!visible_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  Draw();
}

void Progress::Draw() {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun_;
  std::fputs(
      absl::StrCat("\r", ProgressText(title_, done_ - first_, done_, total_, elapsed.count()),
                   "\033[K")
          .c_str(),
      stderr);
}

std::string ProgressText(const std::string& title, std::int64_t worked, std::int64_t done,
                         std::int64_t total, double seconds) {
  std::string line = title + " ";
  if (total > 0) {
    const auto filled = static_cast<std::size_t>(kBarWidth * std::min(done, total) / total);
    absl::StrAppend(&line, "[", std::string(filled, '#'), std::string(kBarWidth - filled, '.'),
                    "] ", done, "/", total);
  } else {
    absl::StrAppend(&line, done);
  }
  // In the first second the rate only reflects how fast buffers fill.
  if (seconds < 1 || worked <= 0) return line;
  const double rate = static_cast<double>(worked) / seconds;
  absl::StrAppendFormat(&line, "  %.1f/s", rate);
  if (total > done) {
    const auto left = std::llround(static_cast<double>(total - done) / rate);
    absl::StrAppendFormat(&line, "  %d:%02d left", left / 60, left % 60);
  }
  return line;
}

}  // namespace homing::client
