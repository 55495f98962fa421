#include "tests/integration/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace homing {
namespace {

std::string TemporaryFile() {
  std::string path = (std::filesystem::temp_directory_path() / "homing_stderr_XXXXXX").string();
  const int file = ::mkstemp(path.data());
  if (file >= 0) ::close(file);
  return path;
}

}  // namespace

Program::Program(const std::vector<std::string>& command) : stderr_path_(TemporaryFile()) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return;
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::dup2(pipe[1], STDOUT_FILENO);
    const int errors = ::open(stderr_path_.c_str(), O_WRONLY | O_TRUNC);
    ::dup2(errors, STDERR_FILENO);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ::close(pipe[1]);
  stdout_ = pipe[0];
}

Program::~Program() {
  if (!exit_code_ && pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (stdout_ >= 0) ::close(stdout_);
  std::filesystem::remove(stderr_path_);
}

std::optional<std::string> Program::ReadLine() {
  while (true) {
    const std::size_t end = buffer_.find('\n');
    if (end != std::string::npos) {
      lines_.push_back(buffer_.substr(0, end));
      buffer_.erase(0, end + 1);
      return lines_.back();
    }
    std::array<char, 65536> bytes{};
    const ssize_t count = ::read(stdout_, bytes.data(), bytes.size());
    if (count <= 0) return std::nullopt;
    buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

void Program::Signal(int signal) const { ::kill(pid_, signal); }

int Program::Wait() {
  while (ReadLine()) {
  }
  if (!exit_code_) {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return *exit_code_;
}

std::string Program::Stderr() const {
  std::ifstream file(stderr_path_);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace homing
