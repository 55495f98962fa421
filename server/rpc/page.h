// Pagination: page sizes, and opaque tokens for the start of the next page.
#ifndef SERVER_RPC_PAGE_H_
#define SERVER_RPC_PAGE_H_

#include <string>

#include "absl/status/statusor.h"

namespace homing::server {

// 0: 100. INVALID_ARGUMENT: not in [0, 1000].
absl::StatusOr<int> DecodePageSize(int page_size);

// A token is valid for its `scope` (the parent listed) only.
std::string EncodePageToken(const std::string& scope, const std::string& position);
// The position; empty for an empty token. INVALID_ARGUMENT: not a token of `scope`.
absl::StatusOr<std::string> DecodePageToken(const std::string& scope, const std::string& token);
// A position that is a number; 0 if empty. INVALID_ARGUMENT.
absl::StatusOr<std::size_t> DecodeNumberToken(const std::string& position);

}  // namespace homing::server

#endif  // SERVER_RPC_PAGE_H_
