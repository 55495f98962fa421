#include "server/rpc/unary_call.h"

#include <grpcpp/impl/codegen/proto_utils.h>

#include "absl/strings/str_cat.h"
#include "server/base/error_reason.h"
#include "server/rpc/request_bytes.h"

namespace homing::server {

UnaryCall::UnaryCall(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc,
                     std::unique_ptr<Message> request, std::unique_ptr<Message> response,
                     Handler handler)
    : core_(core),
      answers_(core->answers),
      share_(answers_.get()),
      incoming_(core, *context, rpc),
      request_share_(core->requests, incoming_.turn_key()),
      watch_(core, context),
      handler_(std::move(handler)),
      opened_(core->options.clock()),
      request_(std::move(request)),
      response_(std::move(response)) {}

absl::Status UnaryCall::Admit() {
  HOMING_RETURN_IF_ERROR(incoming_.identified());
  auto slot = core_->unread.Enter(incoming_.turn_key());
  if (!slot.ok()) {
    return WithReason(
        absl::ResourceExhaustedError("too many calls wait for their requests to arrive"),
        {"UNREAD", {}});
  }
  unread_slot_ = *std::move(slot);
  return absl::OkStatus();
}

void UnaryCall::Open() {
  self_ = shared_from_this();
  absl::Status admitted = Admit();
  if (!core_->streams.Add(self_)) admitted = DrainingError();
  if (admitted.ok()) {
    StartRead(&bytes_);
  } else {
    EndUnread(admitted);
  }
}

void UnaryCall::EndUnread(const absl::Status& status) {
  if (unread_.exchange(false)) End(status);
}

void UnaryCall::Tick() {
  if (core_->options.clock() - opened_ > kRequestTime) EndUnread(RequestTimeError());
}

void UnaryCall::OnReadDone(bool ok) {
  if (!unread_.exchange(false)) return;
  unread_slot_.Leave();
  absl::Status parsed = ParseOnlyRequest(ok, watch_, &bytes_, request_.get());
  bytes_.Clear();
  if (parsed.ok()) parsed = HoldRequest();
  if (parsed.ok()) {
    handler_(shared_from_this(), *request_, response_.get());
  } else {
    End(parsed);
  }
}

absl::Status UnaryCall::Hold() {
  // The message, its bytes, and what gRPC makes of them.
  constexpr std::int64_t kCopies = 3;
  const auto bytes = static_cast<std::int64_t>(response_->ByteSizeLong());
  if (share_.TrySet(kCopies * bytes)) return absl::OkStatus();
  return WithReason(absl::ResourceExhaustedError(
                        absl::StrCat("this answer of ", bytes,
                                     " bytes and those that clients have not read yet need more "
                                     "than memory-quota, ",
                                     answers_->most(), " bytes")),
                    {"ANSWER_MEMORY", {}});
}

absl::Status UnaryCall::HoldRequest() {
  // Of smaller ones the pools bound the number.
  constexpr std::size_t kLarge = 64 << 10;
  const std::size_t bytes = request_->SpaceUsedLong();
  if (bytes <= kLarge || request_share_.TrySet(static_cast<std::int64_t>(bytes))) {
    return absl::OkStatus();
  }
  return RequestMemoryError(core_->requests->most());
}

void UnaryCall::End(const absl::Status& status) {
  const grpc::Status ended = incoming_.Finish(status.ok() ? Hold() : status);
  bool owned = false;
  if (ended.ok()) grpc::SerializationTraits<Message>::Serialize(*response_, &bytes_, &owned);
  response_.reset();
  request_.reset();
  request_share_.TrySet(0);
  if (ended.ok()) {
    StartWriteAndFinish(&bytes_, grpc::WriteOptions(), ended);
  } else {
    Finish(ended);
  }
}

void UnaryCall::OnDone() {
  watch_.Forget();
  unread_slot_.Leave();
  const Ptr self = std::move(self_);
  core_->streams.Remove(self);
}

}  // namespace homing::server
