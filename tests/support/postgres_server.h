// PostgreSQL for one test program: a database cluster in a temporary folder, on a Unix socket.
#ifndef TESTS_SUPPORT_POSTGRES_SERVER_H_
#define TESTS_SUPPORT_POSTGRES_SERVER_H_

#include <memory>
#include <string>

#include "tests/support/temporary_folder.h"

namespace homing::test {

// Needs Debian's package postgresql. As root it runs as the user postgres.
class PostgresServer {
 public:
  // Started at the first use; null, with the reason, if it cannot be. Stopped when the program
  // ends.
  static PostgresServer* Shared(std::string* reason);

  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  // A new, empty database; its URL.
  std::string NewDatabase();
  std::string UrlOf(const std::string& database) const;
  // Runs SQL by psql and returns its output, a row a line, columns separated by "|".
  std::string Query(const std::string& database, const std::string& sql) const;
  // Stops at once, as after a power failure.
  void Crash();
  // Starts again; what pg_ctl printed.
  std::string Start();
  // REQUIRES: this one has crashed. A second one with the same data, not started.
  std::unique_ptr<PostgresServer> Copy() const;
  // Starts as a replica does that is promoted: with a new timeline. REQUIRES: crashed.
  void StartPromoted();
  std::string socket_folder() const { return folder_.File(""); }

 private:
  PostgresServer() = default;
  // Empty: started.
  std::string Prepare();
  std::string Control(const std::string& arguments) const;

  TemporaryFolder folder_;
  bool is_running_ = false;
  int databases_ = 0;
};

}  // namespace homing::test

#endif  // TESTS_SUPPORT_POSTGRES_SERVER_H_
