#include "server/access/token_book.h"

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include <algorithm>
#include <filesystem>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"
#include "server/access/identity.h"
#include "server/access/private_file.h"
#include "server/access/text_table.h"

namespace homing::server {
namespace {

constexpr char kPrefix[] = "sha256:";
constexpr std::size_t kTokenBytes = 32;

std::optional<TokenHash> HashOfText(const std::string& text) {
  const std::string hex = text.substr(std::min(text.size(), sizeof(kPrefix) - 1));
  const bool digits = std::all_of(hex.begin(), hex.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
  });
  TokenHash hash{};
  if (!absl::StartsWith(text, kPrefix) || hex.size() != 2 * hash.size() || !digits) {
    return std::nullopt;
  }
  const std::string bytes = absl::HexStringToBytes(hex);
  std::copy(bytes.begin(), bytes.end(), hash.begin());
  return hash;
}

}  // namespace

TokenHash HashToken(const std::string& token) {
  TokenHash hash{};
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), hash.data());
  return hash;
}

absl::StatusOr<std::string> MakeToken() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    return absl::InternalError("the system gives no random bits");
  }
  return absl::WebSafeBase64Escape(
      std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::string ToText(const TokenHash& hash) {
  return kPrefix + absl::BytesToHexString(
                       std::string(reinterpret_cast<const char*>(hash.data()), hash.size()));
}

absl::StatusOr<TokenBook> TokenBook::Read(const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(const auto table, ReadTextTable("tokens", path, "tokens"));
  TokenBook book;
  book.has_table_ = table.is_present;
  for (const auto& [key, identity] : table.entries) {
    const auto hash = HashOfText(key);
    if (!hash) {
      // The key is not repeated: it may be a token that was put there by mistake.
      return FlagFileError(
          "tokens", path,
          absl::StrCat("gives ", identity.substr(0, 100),
                       " a key that is not sha256: and 64 hexadecimal digits, as `homing-server "
                       "token` makes it"));
    }
    HOMING_RETURN_IF_ERROR(CheckIdentity(identity, "tokens"));
    book.entries_.push_back({*hash, identity});
  }
  return book;
}

std::optional<std::string> TokenBook::Find(const std::string& token) const {
  const TokenHash hash = HashToken(token);
  const Entry* found = nullptr;
  for (const Entry& entry : entries_) {
    if (CRYPTO_memcmp(entry.hash.data(), hash.data(), hash.size()) == 0) {
      found = &entry;
    }
  }
  return found == nullptr ? std::nullopt : std::optional(found->identity);
}

absl::Status AddToken(const std::string& path, const std::string& identity, const TokenHash& hash) {
  HOMING_RETURN_IF_ERROR(CheckNewIdentity(identity, "identity"));
  std::string before;
  bool has_table = false;
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    // Do not write to a file that could not be read afterwards.
    HOMING_ASSIGN_OR_RETURN(const TokenBook book, TokenBook::Read(path));
    has_table = book.has_table();
    HOMING_ASSIGN_OR_RETURN(before, ReadFlagFile("tokens", path));
  }
  const bool ends_line = before.empty() || before.back() == '\n';
  return AppendPrivateFile(path, absl::StrCat(ends_line ? "" : "\n", has_table ? "" : "[tokens]\n",
                                              "\"", ToText(hash), "\" = \"", identity, "\"\n"));
}

}  // namespace homing::server
