#include "server/archive_streams.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/status_macros.h"
#include "server/journey_archive.h"
#include "server/message_conversion.h"
#include "server/status_conversion.h"

namespace homing::server {
namespace {

constexpr std::size_t kChunk = 256 << 10;

}  // namespace

void ExportStream::Open() {
  self_ = shared_from_this();
  if (!core_->streams.Add(self_)) {
    Finish(ToGrpcStatus(DrainingError()));
    return;
  }
  const bool admitted = core_->pool.TryRun([self = self_] {
    const absl::Status status = Guarded([&] { return self->Encode(); });
    if (status.ok()) {
      self->WriteNext();
    } else {
      self->Finish(ToGrpcStatus(status));
    }
  });
  if (!admitted) {
    Finish(ToGrpcStatus(BusyError()));
  }
}

absl::Status ExportStream::Encode() {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(name_, "name"));
  HOMING_ASSIGN_OR_RETURN(auto journey, core_->catalog.Open(name.ToString()));
  const LiveJourneys one = {std::move(journey)};
  const MapsLock lock(one);
  HOMING_ASSIGN_OR_RETURN(file_, EncodeJourney(one.front()->record(), one.front()->map()));
  return absl::OkStatus();
}

void ExportStream::WriteNext() {
  if (written_ >= file_.size()) {
    Finish(grpc::Status::OK);
    return;
  }
  chunk_.set_chunk(file_.substr(written_, kChunk));
  written_ += chunk_.chunk().size();
  StartWrite(&chunk_);
}

void ExportStream::OnWriteDone(bool ok) {
  if (ok) {
    WriteNext();
  } else {
    Finish(grpc::Status::CANCELLED);
  }
}

void ExportStream::OnDone() {
  const std::shared_ptr<ExportStream> self = std::move(self_);
  core_->streams.Remove(self);
}

void ImportStream::Open() {
  self_ = shared_from_this();
  if (core_->streams.Add(self_)) {
    StartRead(&request_);
  } else {
    Finish(ToGrpcStatus(DrainingError()));
  }
}

absl::Status ImportStream::Take(const v1::ImportJourneyRequest& request) {
  if (request.request_case() == v1::ImportJourneyRequest::kName) {
    if (!name_.empty()) {
      return absl::InvalidArgumentError("name came twice; only the first message is name");
    }
    name_ = request.name();
    return ParseJourneyName(name_, "name").status();
  }
  if (name_.empty()) {
    return absl::InvalidArgumentError("chunk came first; the first message must be name");
  }
  const auto size = static_cast<std::int64_t>(file_.size() + request.chunk().size());
  if (size > static_cast<std::int64_t>(kMaxArchiveBytes)) {
    return absl::InvalidArgumentError(absl::StrCat("chunk makes the file ", size,
                                                   " bytes; at most ",
                                                   static_cast<std::int64_t>(kMaxArchiveBytes)));
  }
  file_ += request.chunk();
  return absl::OkStatus();
}

void ImportStream::OnReadDone(bool ok) {
  if (!ok) {
    if (!core_->pool.TryRun([self = self_] { self->Complete(); })) {
      Finish(ToGrpcStatus(BusyError()));
    }
    return;
  }
  const absl::Status status = Guarded([this] { return Take(request_); });
  if (status.ok()) {
    request_.Clear();
    StartRead(&request_);
  } else {
    Finish(ToGrpcStatus(status));
  }
}

absl::Status ImportStream::Store() {
  if (name_.empty()) {
    return absl::InvalidArgumentError("name is missing; the first message must be name");
  }
  HOMING_ASSIGN_OR_RETURN(ArchivedJourney archive, DecodeJourney(file_));
  archive.record.name = name_;
  archive.record.create_time_ns = WallClockNs();
  HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                          core_->catalog.Import(archive.record, archive.map));
  *response_->mutable_journey() = EncodeJourneyRecord(record);
  return absl::OkStatus();
}

void ImportStream::Complete() {
  Finish(ToGrpcStatus(Guarded([this] { return Store(); })));
}

void ImportStream::OnDone() {
  const std::shared_ptr<ImportStream> self = std::move(self_);
  core_->streams.Remove(self);
}

}  // namespace homing::server
