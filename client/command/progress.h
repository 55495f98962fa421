// A progress bar on stderr, on a terminal only.
#ifndef CLIENT_COMMAND_PROGRESS_H_
#define CLIENT_COMMAND_PROGRESS_H_

#include <chrono>
#include <cstdint>
#include <string>

namespace homing::client {

// "recording [####....] 12/48  9.8/s  0:04 left": `done` of `total` (-1: not known), of which
// `worked` in the last `seconds`.
std::string ProgressText(const std::string& title, std::int64_t worked, std::int64_t done,
                         std::int64_t total, double seconds);

// Not thread-safe.
class Progress {
 public:
  // `total` -1: not known. Draws nothing unless stderr is a terminal.
  Progress(std::string title, std::int64_t total, bool wanted = true);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `done` of total; redrawn ten times a second at most.
  void Set(std::int64_t done);

 private:
  void Draw();

  std::string title_;
  std::int64_t total_;
  bool visible_;
  std::int64_t done_ = 0;
  // Done when it was set first; -1: not yet.
  std::int64_t first_ = -1;
  std::chrono::steady_clock::time_point begun_{};
  std::chrono::steady_clock::time_point drawn_{};
};

}  // namespace homing::client

#endif  // CLIENT_COMMAND_PROGRESS_H_
