#include "server/base/error_reason.h"

#include "absl/strings/cord.h"
#include "homing/base/limit_error.h"

namespace homing::server {
namespace {

constexpr const char* kReasonUrl = kReasonPayload;
constexpr char kMetadataUrl[] = "homing/metadata/";

}  // namespace

absl::Status WithReason(absl::Status status, const ErrorReason& reason) {
  status.SetPayload(kReasonUrl, absl::Cord(reason.reason));
  for (const auto& [key, value] : reason.metadata) {
    status.SetPayload(kMetadataUrl + key, absl::Cord(value));
  }
  return status;
}

ErrorReason ReasonOf(const absl::Status& status) {
  ErrorReason result;
  result.reason = absl::StatusCodeToString(status.code());
  const std::string prefix = kMetadataUrl;
  status.ForEachPayload([&](absl::string_view url, const absl::Cord& value) {
    const std::string name(url);
    if (name == kReasonUrl) {
      result.reason = std::string(value);
    } else if (name.compare(0, prefix.size(), prefix) == 0) {
      result.metadata[name.substr(prefix.size())] = std::string(value);
    }
  });
  return result;
}

}  // namespace homing::server
