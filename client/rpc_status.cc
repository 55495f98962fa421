#include "client/rpc_status.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"

namespace homing::client {
namespace {

constexpr char kFromServerUrl[] = "homing.client/from-server";
constexpr char kRetryDelayUrl[] = "homing.client/retry-delay-ms";
// A server asks for seconds. A longer wait would silence a robot.
constexpr std::chrono::milliseconds kMaxRetryDelay = std::chrono::minutes(1);

// `details` is a google.rpc.Status (trailer grpc-status-details-bin).
std::optional<std::chrono::milliseconds> FindRetryInfo(const std::string& details) {
  google::rpc::Status status;
  if (!status.ParseFromString(details)) return std::nullopt;
  for (const google::protobuf::Any& any : status.details()) {
    google::rpc::RetryInfo info;
    if (any.UnpackTo(&info)) {
      const std::chrono::milliseconds delay(
          google::protobuf::util::TimeUtil::DurationToMilliseconds(info.retry_delay()));
      return std::clamp(delay, std::chrono::milliseconds(0), kMaxRetryDelay);
    }
  }
  return std::nullopt;
}

}  // namespace

absl::Status FromGrpc(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  absl::Status result(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
  auto delay = FindRetryInfo(status.error_details());
  if (!delay && absl::IsCancelled(result)) delay = std::chrono::milliseconds(0);
  result.SetPayload(kFromServerUrl, absl::Cord());
  if (delay) {
    result.SetPayload(kRetryDelayUrl, absl::Cord(absl::StrCat(delay->count())));
  }
  return result;
}

std::optional<std::chrono::milliseconds> RetryDelay(const absl::Status& status) {
  const auto payload = status.GetPayload(kRetryDelayUrl);
  std::int64_t milliseconds = 0;
  if (!payload || !absl::SimpleAtoi(std::string(*payload), &milliseconds)) return std::nullopt;
  return std::chrono::milliseconds(milliseconds);
}

bool IsFromServer(const absl::Status& status) {
  return status.GetPayload(kFromServerUrl).has_value();
}

bool IsReset(const absl::Status& status) {
  const bool code = absl::IsInternal(status) || absl::IsUnknown(status);
  return code && (absl::StrContains(status.message(), "RST_STREAM") ||
                  absl::StrContains(status.message(), "http2 header with status: "));
}

bool IsRetriable(const absl::Status& status) {
  return absl::IsUnavailable(status) ||
         ((absl::IsResourceExhausted(status) || absl::IsCancelled(status)) &&
          RetryDelay(status).has_value());
}

}  // namespace homing::client
