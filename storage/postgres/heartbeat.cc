#include "storage/postgres/heartbeat.h"

#include <utility>

#include "homing/base/status_macros.h"
#include "storage/postgres/pg_journey_rows.h"

namespace homing::storage::postgres {
namespace {

constexpr std::chrono::milliseconds kBeatTime{3000};
// A third of the time after which a server counts as dead.
constexpr std::chrono::milliseconds kBeatEvery{5000};

bool IsFault(const absl::Status& status) {
  return absl::IsUnavailable(status) || absl::IsResourceExhausted(status) ||
         absl::IsDataLoss(status) || absl::IsInternal(status);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Heartbeat>> Heartbeat::Start(PgDatabase* database,
                                                            std::int64_t server_id) {
  std::unique_ptr<Heartbeat> heartbeat(new Heartbeat(database, server_id));
  HOMING_RETURN_IF_ERROR(heartbeat->Beat());
  heartbeat->thread_ = std::thread([beating = heartbeat.get()] { beating->Run(); });
  return heartbeat;
}

Heartbeat::~Heartbeat() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  stopped_.NotifyAll();
  if (thread_.joinable()) thread_.join();
  const MutexLock lock(beat_mutex_);
  // If it fails, the row expires.
  if (connection_ != nullptr) {
    RemoveServer(*connection_, server_id_, After(kBeatTime)).IgnoreError();
  }
}

void Heartbeat::Run() {
  while (true) {
    {
      const auto next = After(kBeatEvery);
      const MutexLock lock(mutex_);
      while (!stopping_ && stopped_.WaitUntil(mutex_, next)) {
      }
      if (stopping_) return;
    }
    Beat().IgnoreError();
  }
}

absl::Status Heartbeat::Beat() {
  const MutexLock lock(beat_mutex_);
  const Deadline deadline = After(kBeatTime);
  absl::Status status;
  if (connection_ == nullptr || connection_->is_lost()) {
    connection_ = nullptr;
    auto connected = database_->Connect(deadline);
    status = connected.status();
    if (connected.ok()) connection_ = *std::move(connected);
  }
  if (connection_ != nullptr) status = postgres::Beat(*connection_, server_id_, deadline);
  NoteWrite(status);
  return status;
}

void Heartbeat::NoteWrite(const absl::Status& written) {
  if (!written.ok() && !IsFault(written)) return;
  const MutexLock lock(mutex_);
  health_ = written;
}

absl::Status Heartbeat::health() {
  const MutexLock lock(mutex_);
  return health_;
}

}  // namespace homing::storage::postgres
