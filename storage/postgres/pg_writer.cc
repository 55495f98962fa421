#include "storage/postgres/pg_writer.h"

#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/postgres/pg_status.h"

namespace homing::storage::postgres {
namespace {

// A robot that waits longer for an answer does better with another server.
constexpr std::chrono::milliseconds kWriteTime{10'000};
constexpr std::chrono::milliseconds kRetryPause{50};

// The deadline often cuts the last try short; then the error of the try before names the fault.
absl::Status WithReason(const absl::Status& last, const absl::Status& before) {
  if (before.ok() || before.message() == last.message()) return last;
  return {last.code(), absl::StrCat(last.message(), "; before: ", before.message())};
}

}  // namespace

absl::StatusOr<PgConnection*> PgWriter::Connection(Deadline deadline) {
  if (connection_ == nullptr || connection_->is_lost()) {
    connection_ = nullptr;
    HOMING_ASSIGN_OR_RETURN(connection_, database_->Connect(deadline));
  }
  return connection_.get();
}

absl::Status PgWriter::Write(Scope scope, const Body& body) {
  const Body in_transaction = [&](PgConnection& connection, Deadline deadline) {
    HOMING_RETURN_IF_ERROR(connection.Execute("BEGIN", deadline));
    const absl::Status status = body(connection, deadline);
    const absl::Status ended = connection.Execute(status.ok() ? "COMMIT" : "ROLLBACK", deadline);
    return status.ok() ? ended : status;
  };
  const Deadline deadline = After(kWriteTime);
  absl::Status before;
  while (true) {
    bool is_lost = false;
    absl::Status status =
        changes_.Use(scope == Scope::kOneStatement ? body : in_transaction, deadline, &is_lost);
    const bool is_again = absl::IsUnavailable(status) && (is_lost || IsConflict(status));
    if (!is_again) return status;
    if (After(kRetryPause) > deadline) return WithReason(status, before);
    before = std::move(status);
    std::this_thread::sleep_for(kRetryPause);
  }
}

std::vector<absl::Status> PgWriter::Append(const std::vector<JourneyAppend>& appends) {
  const MutexLock lock(mutex_);
  ApplyForgotten();
  const Writer writer = [this](Deadline deadline)
                            HOMING_REQUIRES(mutex_) { return Connection(deadline); };
  return appends_.Append(appends, writer, After(kWriteTime));
}

void PgWriter::Forget(const std::string& name) {
  {
    const MutexLock lock(forget_mutex_);
    forgotten_.push_back(name);
  }
  // Otherwise the next append does it.
  if (mutex_.TryLock()) {
    ApplyForgotten();
    mutex_.Unlock();
  }
}

void PgWriter::ApplyForgotten() {
  const MutexLock lock(forget_mutex_);
  for (const std::string& name : forgotten_) appends_.Forget(name);
  forgotten_.clear();
}

}  // namespace homing::storage::postgres
