// Bearer tokens: stored as hashes, compared in constant time.
#ifndef SERVER_ACCESS_TOKEN_BOOK_H_
#define SERVER_ACCESS_TOKEN_BOOK_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::server {

// SHA-256. A token has 256 random bits, so that a fast hash is safe.
using TokenHash = std::array<unsigned char, 32>;

TokenHash HashToken(const std::string& token);
// 43 characters of [A-Za-z0-9_-]. INTERNAL: the system provides no random bits.
absl::StatusOr<std::string> MakeToken();
// The form in the file: "sha256:" and 64 hexadecimal digits.
std::string ToText(const TokenHash& hash);

// Hashes of tokens with their identities. An identity may have several tokens, so that one can be
// replaced without an interruption. Immutable.
class TokenBook {
 public:
  // Empty: no token is valid.
  TokenBook() = default;
  // File: [tokens], "sha256:HEX" = "robots/r1". INVALID_ARGUMENT.
  static absl::StatusOr<TokenBook> Read(const std::string& path);

  // The file holds [tokens], with or without entries.
  bool has_table() const { return has_table_; }
  // The identity of the token. Compares with every entry, so that the time reveals nothing.
  std::optional<std::string> Find(const std::string& token) const;

 private:
  struct Entry {
    TokenHash hash{};
    std::string identity;
  };
  bool has_table_ = false;
  std::vector<Entry> entries_;
};

// Appends a line to the file of tokens; creates it (readable by its owner only) if missing.
// The identity must be a new one's (CheckNewIdentity).
// INVALID_ARGUMENT (identity, path).
absl::Status AddToken(const std::string& path, const std::string& identity, const TokenHash& hash);

}  // namespace homing::server

#endif  // SERVER_ACCESS_TOKEN_BOOK_H_
