#include "server/rpc/status_conversion.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <new>
#include <string>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"
#include "homing/base/field_error.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxMessage = 1000;
constexpr std::int64_t kDefaultRetryMs = 1000;

bool IsHidden(absl::StatusCode code) {
  return code == absl::StatusCode::kInternal || code == absl::StatusCode::kUnknown;
}

// Shortened, and safe in a header and in a Protobuf string.
std::string MessageOf(const absl::Status& status) {
  if (IsHidden(status.code())) {
    spdlog::error("{}", std::string(status.ToString()));
    return "internal error; see the server's log";
  }
  const std::string whole(status.message());
  std::string message;
  for (const char c : whole.substr(0, kMaxMessage)) {
    message += c >= ' ' && c <= '~' ? std::string(1, c) : absl::CHexEscape(std::string(1, c));
  }
  return whole.size() > kMaxMessage ? message + "..." : message;
}

void AddErrorInfo(const absl::Status& status, google::rpc::Status* details) {
  const ErrorReason reason = ReasonOf(status);
  google::rpc::ErrorInfo info;
  info.set_reason(reason.reason);
  info.set_domain("homing");
  info.mutable_metadata()->insert(reason.metadata.begin(), reason.metadata.end());
  details->add_details()->PackFrom(info);
}

void AddRetryInfo(const absl::Status& status, google::rpc::Status* details) {
  const ErrorReason reason = ReasonOf(status);
  const auto said = reason.metadata.find(kRetryAfterMs);
  std::int64_t ms = kDefaultRetryMs;
  if (said == reason.metadata.end() || !absl::SimpleAtoi(said->second, &ms)) {
    ms = kDefaultRetryMs;
  }
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(ms / 1000);
  retry.mutable_retry_delay()->set_nanos(static_cast<std::int32_t>(ms % 1000 * 1'000'000));
  details->add_details()->PackFrom(retry);
}

void AddBadRequest(const absl::Status& status, google::rpc::Status* details) {
  google::rpc::BadRequest bad;
  auto* violation = bad.add_field_violations();
  violation->set_field(FieldOf(status).value_or(""));
  violation->set_description(details->message());
  details->add_details()->PackFrom(bad);
}

}  // namespace

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) {
    return grpc::Status::OK;
  }
  google::rpc::Status details;
  details.set_code(static_cast<int>(status.code()));
  details.set_message(MessageOf(status));
  AddErrorInfo(status, &details);
  if (absl::IsResourceExhausted(status) || absl::IsUnavailable(status)) {
    AddRetryInfo(status, &details);
  }
  if (absl::IsInvalidArgument(status)) {
    AddBadRequest(status, &details);
  }
  return {static_cast<grpc::StatusCode>(status.code()), details.message(),
          details.SerializeAsString()};
}

absl::Status Guarded(const std::function<absl::Status()>& call) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory");
  } catch (const std::exception& error) {
    return absl::InternalError(error.what());
  } catch (...) {
    return absl::InternalError("unknown exception");
  }
}

absl::Status DrainingError() {
  return WithReason(absl::UnavailableError("the server is shutting down"), {"DRAINING", {}});
}

absl::Status IdleError() {
  return WithReason(absl::UnavailableError("the stream was idle for too long"), {"IDLE", {}});
}

absl::Status BusyError() {
  return WithReason(absl::ResourceExhaustedError("too many requests wait for a worker"),
                    {"BUSY", {}});
}

}  // namespace homing::server
