#include "server/rpc/page.h"

#include <cstdint>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing::server {
namespace {

constexpr int kDefaultPageSize = 100;
constexpr int kMaxPageSize = 1000;

absl::Status BadToken() {
  return FieldError("page_token", "must be next_page_token of the page before");
}

}  // namespace

absl::StatusOr<int> DecodePageSize(int page_size) {
  HOMING_RETURN_IF_ERROR(CheckRange("page_size", page_size, 0, kMaxPageSize));
  return page_size == 0 ? kDefaultPageSize : page_size;
}

std::string EncodePageToken(const std::string& scope, const std::string& position) {
  return absl::WebSafeBase64Escape(absl::StrCat(scope, "\n", position));
}

absl::StatusOr<std::string> DecodePageToken(const std::string& scope, const std::string& token) {
  if (token.empty()) {
    return std::string();
  }
  std::string plain;
  const std::string prefix = scope + "\n";
  if (!absl::WebSafeBase64Unescape(token, &plain) || plain.compare(0, prefix.size(), prefix) != 0) {
    return BadToken();
  }
  return plain.substr(prefix.size());
}

absl::StatusOr<std::size_t> DecodeNumberToken(const std::string& position) {
  std::uint32_t number = 0;
  if (!position.empty() && !absl::SimpleAtoi(position, &number)) {
    return BadToken();
  }
  return std::size_t{number};
}

}  // namespace homing::server
