#include "storage/query_connections.h"

#include "homing/base/status_macros.h"

namespace homing::storage {

absl::Status QueryConnections::Read(const std::function<absl::Status(Connection&)>& body) {
  HOMING_ASSIGN_OR_RETURN(std::unique_ptr<Connection> taken, Take());
  // Gives it back when `body` throws, too.
  const auto give_back = [this](Connection* used) { GiveBack(std::unique_ptr<Connection>(used)); };
  const std::unique_ptr<Connection, decltype(give_back)> connection(taken.release(), give_back);
  return connection->Read([&] { return body(*connection); });
}

absl::StatusOr<std::unique_ptr<Connection>> QueryConnections::Take() {
  {
    std::unique_lock lock(mutex_);
    given_back_.wait(lock, [this] { return !free_.empty() || unopened_ > 0; });
    if (!free_.empty()) {
      std::unique_ptr<Connection> connection = std::move(free_.back());
      free_.pop_back();
      return connection;
    }
    --unopened_;
  }
  auto connection = Connection::Open(path_, access_, busy_timeout_ms_);
  if (!connection.ok()) {
    std::lock_guard lock(mutex_);
    ++unopened_;
    given_back_.notify_one();
  }
  return connection;
}

void QueryConnections::GiveBack(std::unique_ptr<Connection> connection) {
  std::lock_guard lock(mutex_);
  free_.push_back(std::move(connection));
  given_back_.notify_one();
}

}  // namespace homing::storage
