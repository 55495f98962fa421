// Command lines and configuration files. Input: arguments, a line each, to an empty line; then the
// file.
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <sstream>
#include <vector>

#include "server/config/option_table.h"
#include "server/config/server_options.h"
#include "tests/fuzz/fuzz_input.h"

namespace homing::fuzz {
namespace {

// Error messages are for users: suppress them here.
class Silence {
 public:
  Silence() : out_(std::cout.rdbuf(sink_.rdbuf())), errors_(std::cerr.rdbuf(sink_.rdbuf())) {}
  ~Silence() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(errors_);
  }

 private:
  std::ostringstream sink_;
  std::streambuf* out_;
  std::streambuf* errors_;
};

void Run(const std::string& text) {
  const std::string path = "/dev/shm/homing_fuzz_" + std::to_string(::getpid()) + ".toml";
  std::vector<std::string> words = {"homing-server", "--config", path};
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && !line.empty();) {
    // Ends at a zero, as arguments do.
    words.emplace_back(line.c_str());
  }
  std::ostringstream file;
  file << lines.rdbuf();
  std::ofstream(path, std::ios::binary) << file.str();
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  const Silence silence;
  const server::ServerCommand command =
      server::ParseCommandLine(static_cast<int>(arguments.size()), arguments.data());
  if (server::Validate(command.options).ok()) Require(!server::ToToml(command.options).empty());
}

}  // namespace
}  // namespace homing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::Run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
