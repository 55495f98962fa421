// Bearer tokens: kept as hashes, compared in constant time. Source: own design.
#ifndef SERVER_ACCESS_TOKEN_BOOK_H_
#define SERVER_ACCESS_TOKEN_BOOK_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::server {

// SHA-256. A token is 256 random bits, so that there is nothing to guess and no need of a slow
// hash.
using TokenHash = std::array<unsigned char, 32>;

TokenHash HashToken(const std::string& token);
// 43 characters of [A-Za-z0-9_-]. INTERNAL: the system gives no random bits.
absl::StatusOr<std::string> MakeToken();
// As it stands in the file: "sha256:" and 64 hexadecimal digits.
std::string ToText(const TokenHash& hash);

// A token's hash beside whose it is. Several tokens may be one identity's, so that one can be
// replaced without a gap.
class TokenBook {
 public:
  // Nobody has a token.
  TokenBook() = default;
  // File: [tokens], "sha256:HEX" = "robots/r1". INVALID_ARGUMENT.
  static absl::StatusOr<TokenBook> Read(const std::string& path);

  bool empty() const { return entries_.empty(); }
  // Whose it is. Every entry is looked at, whatever it holds.
  std::optional<std::string> Find(const std::string& token) const;

 private:
  struct Entry {
    TokenHash hash{};
    std::string identity;
  };
  std::vector<Entry> entries_;
};

// Adds a line to the file of tokens, making the file (owner only) if there is none.
// INVALID_ARGUMENT (identity, path).
absl::Status AddToken(const std::string& path, const std::string& identity, const TokenHash& hash);

}  // namespace homing::server

#endif  // SERVER_ACCESS_TOKEN_BOOK_H_
