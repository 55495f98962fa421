// PostgreSQL with a synchronous replica, and servers on it, for the checks.
#ifndef TESTS_SCALE_SHARED_DATABASE_H_
#define TESTS_SCALE_SHARED_DATABASE_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/faults/server_under_test.h"
#include "tests/support/temporary_folder.h"

namespace homing::scale {

class SharedDatabase {
 public:
  // `script`: database.sh or patroni.sh.
  SharedDatabase(std::string server, std::string script)
      : server_program_(std::move(server)), script_(std::move(script)) {}
  ~SharedDatabase();

  // False: it cannot be started.
  bool Start();
  // Kills the primary and waits until its replica leads. False: it failed.
  bool FailOver() const;
  // Makes a new replica of the promoted one. False: it failed.
  bool AddReplica() const;
  const std::string& url() const { return url_; }
  // Starts `count` servers on it. False: one does not start.
  bool StartServers(int count);
  void StopServers();
  faults::ServerUnderTest& server(std::size_t index) { return *servers_[index]; }
  // "HOST:PORT,HOST:PORT".
  std::string addresses() const;

 private:
  // The output; empty if the script failed.
  std::string Run(const std::string& command) const;

  const std::string server_program_;
  const std::string script_;
  TemporaryFolder folder_;
  std::string url_;
  std::vector<std::unique_ptr<faults::ServerUnderTest>> servers_;
};

}  // namespace homing::scale

#endif  // TESTS_SCALE_SHARED_DATABASE_H_
