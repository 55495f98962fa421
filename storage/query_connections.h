// Read-only connections for queries, which run beside the writer (WAL). Source: own design.
#ifndef STORAGE_QUERY_CONNECTIONS_H_
#define STORAGE_QUERY_CONNECTIONS_H_

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "storage/connection.h"

namespace homing::storage {

// Thread-safe. Connections are opened when needed and kept; who finds all in use waits.
class QueryConnections {
 public:
  QueryConnections(std::string path, Connection::Access access, int busy_timeout_ms,
                   int max_connections)
      : path_(std::move(path)),
        access_(access),
        busy_timeout_ms_(busy_timeout_ms),
        unopened_(max_connections) {}

  // Runs `body` in a read transaction of a connection that no one else uses meanwhile.
  absl::Status Read(const std::function<absl::Status(Connection&)>& body);

 private:
  absl::StatusOr<std::unique_ptr<Connection>> Take();
  void GiveBack(std::unique_ptr<Connection> connection);

  const std::string path_;
  const Connection::Access access_;
  const int busy_timeout_ms_;
  std::mutex mutex_;
  std::condition_variable given_back_;
  // Both guarded by mutex_.
  int unopened_;
  std::vector<std::unique_ptr<Connection>> free_;
};

}  // namespace homing::storage

#endif  // STORAGE_QUERY_CONNECTIONS_H_
