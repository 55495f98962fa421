// PostgreSQL with a synchronous replica, and servers on it, for the checks.
#ifndef TESTS_SCALE_SHARED_DATABASE_H_
#define TESTS_SCALE_SHARED_DATABASE_H_

#include <memory>
#include <string>
#include <vector>

#include "tests/faults/server_under_test.h"
#include "tests/scale/checks.h"
#include "tests/support/temporary_folder.h"

namespace homing::scale {

class SharedDatabase {
 public:
  explicit SharedDatabase(const Programs& programs) : programs_(programs) {}
  ~SharedDatabase();

  // False: it cannot be started.
  bool Start();
  // Stops the primary at once and promotes the replica. False: it failed.
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

  const Programs programs_;
  TemporaryFolder folder_;
  std::string url_;
  std::vector<std::unique_ptr<faults::ServerUnderTest>> servers_;
};

}  // namespace homing::scale

#endif  // TESTS_SCALE_SHARED_DATABASE_H_
