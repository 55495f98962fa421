// homing-server as a child process that may be killed and started again on the same port.
#ifndef TESTS_FAULTS_SERVER_UNDER_TEST_H_
#define TESTS_FAULTS_SERVER_UNDER_TEST_H_

#include <memory>
#include <string>
#include <vector>

#include "tests/integration/program.h"

namespace homing::faults {

class ServerUnderTest {
 public:
  // Its database is `folder`/homing.db, or the one at `url`. `environment`: "NAME=VALUE", for
  // example the faulty disk.
  ServerUnderTest(std::string program, std::string folder, std::string url = "")
      : program_(std::move(program)), folder_(std::move(folder)), url_(std::move(url)) {}

  // False, with its output on stderr, if it does not listen.
  bool Start(const std::vector<std::string>& environment = {},
             const std::vector<std::string>& flags = {});
  // kill -9. Answers that it sent before are still under way to the clients.
  void Kill();
  // SIGTERM; its exit code.
  int Stop();

  const std::string& address() const { return address_; }
  const std::string& folder() const { return folder_; }
  std::string Url() const { return url_.empty() ? "sqlite:" + folder_ + "/homing.db" : url_; }
  // Such as SIGSTOP.
  void Signal(int signal) const { server_->Signal(signal); }
  pid_t pid() const { return server_ ? server_->pid() : -1; }

 private:
  const std::string program_;
  const std::string folder_;
  const std::string url_;
  // Port 0 at first, then the one that it picked.
  std::string address_ = "127.0.0.1:0";
  std::unique_ptr<Program> server_;
};

}  // namespace homing::faults

#endif  // TESTS_FAULTS_SERVER_UNDER_TEST_H_
