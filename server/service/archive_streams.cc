#include "server/service/archive_streams.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/rpc/request_bytes.h"
#include "server/rpc/status_conversion.h"
#include "server/service/journey_archive.h"
#include "server/service/message_conversion.h"

namespace homing::server {

namespace {

// Adds `bytes` to `all`. RESOURCE_EXHAUSTED: these are then more than the quota.
absl::Status TakeMemory(const ServiceCore& core, std::int64_t bytes, const char* what,
                        const char* reason, std::atomic<std::int64_t>* all) {
  const std::int64_t most = core.options.limits.memory_quota;
  if ((*all += bytes) <= most || most == 0) return absl::OkStatus();
  return WithReason(absl::ResourceExhaustedError(absl::StrCat(
                        "the running ", what, " need more than memory-quota, ", most, " bytes")),
                    {reason, {}});
}

}  // namespace

absl::Status ExportStream::Prepare(const v1::ExportJourneyRequest& request, ServiceCore* core,
                                   IncomingCall* call) {
  HOMING_RETURN_IF_ERROR(call->Authorize(request.name()));
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request.name(), "name"));
  HOMING_ASSIGN_OR_RETURN(auto journey, core->catalog.Open(name.ToString()));
  const LiveJourneys one = {std::move(journey)};
  const MapsLock lock(one);
  HOMING_ASSIGN_OR_RETURN(file_, EncodeJourney(one.front()->record(), one.front()->map()));
  bytes_ = static_cast<std::int64_t>(file_.size());
  absl::Status status = TakeMemory(*core, bytes_, "exports", "EXPORT_MEMORY", &core->export_bytes);
  if (!status.ok()) file_ = {};
  return status;
}

absl::StatusOr<std::string> ExportStream::NextChunk() {
  std::string chunk = file_.substr(written_, kChunkBytes);
  written_ += chunk.size();
  return chunk;
}

void ImportStream::Tick() {
  absl::Status status = call_.CheckIdentity();
  if (watch_.IsIdle()) status = IdleError();
  if (!status.ok() && reading_.exchange(false)) FinishWith(status);
}

void ImportStream::ReadNext() {
  reading_ = true;
  StartRead(&bytes_);
}

void ImportStream::Open() {
  self_ = shared_from_this();
  absl::Status entered = call_.EnterStream();
  if (!core_->streams.Add(self_)) {
    entered = DrainingError();
  }
  if (entered.ok()) {
    ReadNext();
  } else {
    FinishWith(entered);
  }
}

absl::Status ImportStream::Take(const v1::ImportJourneyRequest& request) {
  if (request.request_case() == v1::ImportJourneyRequest::kName) {
    if (!name_.empty()) {
      return FieldError("name", "must come once, in the first message");
    }
    name_ = request.name();
    HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(name_, "name"));
    HOMING_RETURN_IF_ERROR(CheckNewJourney(name, "name", "name"));
    // Writing is authorised by the name alone: nothing is looked up.
    return call_.Authorize(name_);
  }
  if (name_.empty()) {
    return FieldError("chunk", "came before name; the first message must be name");
  }
  return TakeChunk(request.chunk());
}

absl::Status ImportStream::TakeChunk(const std::string& chunk) {
  const auto bytes = static_cast<std::int64_t>(chunk.size());
  const auto size = static_cast<std::int64_t>(file_.size()) + bytes;
  if (size > static_cast<std::int64_t>(kMaxArchiveBytes)) {
    return MustBe("chunk", absl::StrCat("a file of ", size),
                  absl::StrCat("at most ", kMaxArchiveBytes, " bytes"));
  }
  taken_ += bytes;
  HOMING_RETURN_IF_ERROR(
      TakeMemory(*core_, bytes, "imports", "IMPORT_MEMORY", &core_->import_bytes));
  file_ += chunk;
  return absl::OkStatus();
}

void ImportStream::OnReadDone(bool ok) {
  if (!reading_.exchange(false)) return;
  if (!ok) {
    if (!core_->archives.TryRun([self = self_] { self->Complete(); }, call_.turn_key())) {
      FinishWith(BusyError());
    }
    return;
  }
  watch_.Moved();
  const absl::Status status = Guarded([this] { return TakeMessage(); });
  bytes_.Clear();
  if (status.ok()) {
    ReadNext();
  } else {
    FinishWith(status);
  }
}

absl::Status ImportStream::TakeMessage() {
  v1::ImportJourneyRequest request;
  HOMING_RETURN_IF_ERROR(ParseRequest(&bytes_, &request));
  return Take(request);
}

absl::Status ImportStream::Store() {
  if (name_.empty()) {
    return FieldError("name", "is missing; the first message must be name");
  }
  // gRPC reports the end of a cancelled stream like the end of a complete one.
  HOMING_RETURN_IF_ERROR(CheckAwaited(&watch_));
  HOMING_ASSIGN_OR_RETURN(ArchivedJourney archive, DecodeJourney(file_, &watch_));
  archive.record.name = name_;
  archive.record.create_time_ns = absl::GetCurrentTimeNanos();
  HOMING_RETURN_IF_ERROR(CheckAwaited(&watch_));
  HOMING_RETURN_IF_ERROR(core_->quota.CheckNew(name_, QuotaBytes(archive.map)));
  HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                          core_->catalog.Import(archive.record, archive.map));
  *response_.mutable_journey() = EncodeJourneyRecord(record);
  return absl::OkStatus();
}

void ImportStream::Complete() {
  FinishWith(Guarded([this] { return Store(); }));
}

void ImportStream::FinishWith(const absl::Status& status) {
  // Frees the file before the answer, after which the client may import the next one.
  FreeFile();
  const grpc::Status ended = call_.Finish(status);
  if (ended.ok()) {
    StartWriteAndFinish(&response_, grpc::WriteOptions(), ended);
  } else {
    Finish(ended);
  }
}

void ImportStream::FreeFile() {
  file_ = {};
  core_->import_bytes -= std::exchange(taken_, 0);
}

void ImportStream::OnDone() {
  watch_.Forget();
  FreeFile();
  const std::shared_ptr<ImportStream> self = std::move(self_);
  core_->streams.Remove(self);
}

}  // namespace homing::server
