// Read-only connections for queries, which run beside the writer (WAL).
#ifndef STORAGE_QUERY_CONNECTIONS_H_
#define STORAGE_QUERY_CONNECTIONS_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "homing/base/mutex.h"
#include "storage/connection.h"

namespace homing::storage {

// Thread-safe. Opens connections on demand and keeps them; a caller waits while all are in use.
class QueryConnections {
 public:
  QueryConnections(std::string path, Connection::Access access, int busy_timeout_ms,
                   int max_connections)
      : path_(std::move(path)),
        access_(access),
        busy_timeout_ms_(busy_timeout_ms),
        unopened_(max_connections) {}

  // Runs `body` in a read transaction, with exclusive use of a connection.
  absl::Status Read(const std::function<absl::Status(Connection&)>& body);

 private:
  absl::StatusOr<std::unique_ptr<Connection>> Take();
  void GiveBack(std::unique_ptr<Connection> connection);

  const std::string path_;
  const Connection::Access access_;
  const int busy_timeout_ms_;
  Mutex mutex_;
  ConditionVariable given_back_;
  int unopened_ HOMING_GUARDED_BY(mutex_);
  std::vector<std::unique_ptr<Connection>> free_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::storage

#endif  // STORAGE_QUERY_CONNECTIONS_H_
