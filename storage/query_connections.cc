#include "storage/query_connections.h"

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"

namespace homing::storage {

absl::Status QueryConnections::Read(const std::function<absl::Status(Connection&)>& body) {
  HOMING_ASSIGN_OR_RETURN(std::unique_ptr<Connection> taken, Take());
  // The deleter returns it also if `body` throws.
  const auto give_back = [this](Connection* used) { GiveBack(std::unique_ptr<Connection>(used)); };
  const std::unique_ptr<Connection, decltype(give_back)> connection(taken.release(), give_back);
  return connection->Read([&] { return body(*connection); });
}

absl::StatusOr<std::unique_ptr<Connection>> QueryConnections::Take() {
  {
    MutexLock lock(mutex_);
    while (free_.empty() && unopened_ == 0) given_back_.Wait(mutex_);
    if (!free_.empty()) {
      std::unique_ptr<Connection> connection = std::move(free_.back());
      free_.pop_back();
      return connection;
    }
    --unopened_;
  }
  auto connection = Connection::Open(path_, access_, busy_timeout_ms_);
  if (!connection.ok()) {
    const MutexLock lock(mutex_);
    ++unopened_;
    given_back_.NotifyOne();
  }
  return connection;
}

void QueryConnections::GiveBack(std::unique_ptr<Connection> connection) {
  const MutexLock lock(mutex_);
  free_.push_back(std::move(connection));
  given_back_.NotifyOne();
}

}  // namespace homing::storage
