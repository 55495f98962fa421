#include "tests/faults/server_under_test.h"

#include <signal.h>

#include <iostream>

namespace homing::faults {

bool ServerUnderTest::Start(const std::vector<std::string>& environment,
                            const std::vector<std::string>& flags) {
  constexpr char kListening[] = "listening on ";
  // env becomes the server: the process is the same.
  std::vector<std::string> command = {"/usr/bin/env"};
  command.insert(command.end(), environment.begin(), environment.end());
  command.insert(command.end(), {program_, "--listen", address_, "--database", Url()});
  command.insert(command.end(), flags.begin(), flags.end());
  server_ = std::make_unique<Program>(command);
  while (const auto line = server_->ReadLine()) {
    if (line->rfind(kListening, 0) == 0) {
      address_ = line->substr(sizeof(kListening) - 1);
      return true;
    }
  }
  std::cerr << "homing-server did not start: " << server_->Stderr();
  server_.reset();
  return false;
}

void ServerUnderTest::Kill() {
  server_->Signal(SIGKILL);
  server_->Wait();
  server_.reset();
}

int ServerUnderTest::Stop() {
  server_->Signal(SIGTERM);
  const int code = server_->Wait();
  server_.reset();
  return code;
}

}  // namespace homing::faults
