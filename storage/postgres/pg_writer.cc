#include "storage/postgres/pg_writer.h"

#include <thread>

#include "homing/base/status_macros.h"
#include "storage/postgres/pg_status.h"

namespace homing::storage::postgres {
namespace {

// A robot that waits longer for an answer does better with another server.
constexpr std::chrono::milliseconds kWriteTime{10'000};
constexpr std::chrono::milliseconds kRetryPause{50};

}  // namespace

absl::StatusOr<PgConnection*> PgWriter::Connection(Deadline deadline) {
  if (connection_ == nullptr || connection_->is_lost()) {
    connection_ = nullptr;
    HOMING_ASSIGN_OR_RETURN(connection_, database_->Connect(deadline));
  }
  return connection_.get();
}

absl::Status PgWriter::WriteOnce(Scope scope, const Body& body, Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(PgConnection* const connection, Connection(deadline));
  if (scope == Scope::kOneStatement) return body(*connection, deadline);
  HOMING_RETURN_IF_ERROR(connection->Execute("BEGIN", deadline));
  const absl::Status status = body(*connection, deadline);
  const absl::Status ended = connection->Execute(status.ok() ? "COMMIT" : "ROLLBACK", deadline);
  return status.ok() ? ended : status;
}

absl::Status PgWriter::Write(Scope scope, const Body& body) {
  const MutexLock lock(mutex_);
  const Deadline deadline = After(kWriteTime);
  while (true) {
    absl::Status status = WriteOnce(scope, body, deadline);
    const bool is_lost = connection_ == nullptr || connection_->is_lost();
    const bool is_again = absl::IsUnavailable(status) && (is_lost || IsConflict(status));
    if (!is_again || After(kRetryPause) > deadline) return status;
    std::this_thread::sleep_for(kRetryPause);
  }
}

std::vector<absl::Status> PgWriter::Append(const std::vector<JourneyAppend>& appends) {
  const MutexLock lock(mutex_);
  const Writer writer = [this](Deadline deadline)
                            HOMING_REQUIRES(mutex_) { return Connection(deadline); };
  return appends_.Append(appends, writer, After(kWriteTime));
}

void PgWriter::Forget(const std::string& name) {
  const MutexLock lock(mutex_);
  appends_.Forget(name);
}

}  // namespace homing::storage::postgres
