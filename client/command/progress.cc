#include "client/command/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "absl/strings/str_cat.h"

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
  done_ = done;
  const auto now = std::chrono::steady_clock::now();
  if (!visible_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  Draw();
}

void Progress::Draw() {
  std::string line = absl::StrCat("\r", title_, " ");
  if (total_ > 0) {
    const auto filled = static_cast<std::size_t>(kBarWidth * std::min(done_, total_) / total_);
    absl::StrAppend(&line, "[", std::string(filled, '#'), std::string(kBarWidth - filled, '.'),
                    "] ", done_, "/", total_);
  } else {
    absl::StrAppend(&line, done_);
  }
  std::fputs((line + "\033[K").c_str(), stderr);
}

}  // namespace homing::client
