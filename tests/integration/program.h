// A real program run as a child process, with its output.
#ifndef TESTS_INTEGRATION_PROGRAM_H_
#define TESTS_INTEGRATION_PROGRAM_H_

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace homing {

class Program {
 public:
  // Starts it; stdout is read line by line, stderr goes to a file.
  explicit Program(const std::vector<std::string>& command);
  // Kills it if it still runs.
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // The next line of stdout; nothing at its end.
  std::optional<std::string> ReadLine();
  void Signal(int signal) const;
  // Reads the rest, then the exit code (128 + signal if killed).
  int Wait();
  // Lines of stdout so far.
  const std::vector<std::string>& lines() const { return lines_; }
  std::string Stderr() const;
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  int stdout_ = -1;
  std::string buffer_;
  std::vector<std::string> lines_;
  std::string stderr_path_;
  std::optional<int> exit_code_;
};

}  // namespace homing

#endif  // TESTS_INTEGRATION_PROGRAM_H_
