// A progress bar on stderr, on a terminal only.
#ifndef CLIENT_COMMAND_PROGRESS_H_
#define CLIENT_COMMAND_PROGRESS_H_

#include <chrono>
#include <cstdint>
#include <string>

namespace homing::client {

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
  std::chrono::steady_clock::time_point drawn_{};
};

}  // namespace homing::client

#endif  // CLIENT_COMMAND_PROGRESS_H_
