#include "server/access/access_control.h"

#include <chrono>
#include <filesystem>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/access/text_table.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

constexpr std::size_t kBearerSize = sizeof("Bearer ") - 1;

absl::Status Unauthenticated(const char* reason, const std::string& message) {
  return WithReason(absl::UnauthenticatedError(message), {reason, {}});
}

// A file may be half written. It is read only after it was unchanged for a second.
bool IsSettled(const std::string& path) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(path, error);
  const auto age = std::filesystem::file_time_type::clock::now() - written;
  return error || age > std::chrono::seconds(1) || age < std::chrono::seconds(-1);
}

}  // namespace

AccessControl::AccessControl(const AccessFiles& files)
    : files_(files),
      is_open_(files.tokens.empty() && files.roles.empty() && files.client_ca.empty()) {}

absl::StatusOr<std::unique_ptr<AccessControl>> AccessControl::Open(const AccessFiles& files) {
  std::unique_ptr<AccessControl> access(new AccessControl(files));
  if (!files.client_ca.empty()) {
    HOMING_ASSIGN_OR_RETURN(access->certificates_,
                            ClientCertificates::Open(files.client_ca, files.crl_dir));
  }
  HOMING_RETURN_IF_ERROR(access->ReadFiles(Reading::kAtOnce));
  return access;
}

absl::Status AccessControl::Reload(Reading reading) {
  absl::Status status = ReadFiles(reading);
  if (certificates_) status.Update(certificates_->Reload());
  return status;
}

absl::Status AccessControl::ReadTokens() {
  HOMING_ASSIGN_OR_RETURN(TokenBook book, TokenBook::Read(files_.tokens));
  const MutexLock lock(mutex_);
  // The file may be cut or half written; with no tokens nobody could connect. A table without
  // entries is deliberate.
  if (!book.has_table() && tokens_->has_table()) return NoTable("tokens", files_.tokens, "tokens");
  tokens_ = std::make_shared<TokenBook>(std::move(book));
  return absl::OkStatus();
}

absl::Status AccessControl::ReadRoles() {
  HOMING_ASSIGN_OR_RETURN(RoleBook book, RoleBook::Read(files_.roles));
  const MutexLock lock(mutex_);
  roles_ = std::make_shared<RoleBook>(std::move(book));
  return absl::OkStatus();
}

absl::Status AccessControl::ReadFiles(Reading reading) {
  const auto is_due = [reading](const std::string& path) {
    return !path.empty() && (reading == Reading::kAtOnce || IsSettled(path));
  };
  absl::Status status;
  if (is_due(files_.tokens)) status.Update(ReadTokens());
  if (is_due(files_.roles)) status.Update(ReadRoles());
  return status;
}

absl::Status AccessControl::CheckCertificate(const std::string& chain_pem) const {
  return certificates_ ? certificates_->Check(chain_pem) : absl::OkStatus();
}

absl::StatusOr<std::string> AccessControl::LendToken(const std::string& identity) {
  HOMING_RETURN_IF_ERROR(CheckIdentity(identity, "identity"));
  HOMING_ASSIGN_OR_RETURN(std::string token, MakeToken());
  const MutexLock lock(mutex_);
  lent_[HashToken(token)] = identity;
  return token;
}

void AccessControl::WithdrawToken(const std::string& token) {
  const MutexLock lock(mutex_);
  lent_.erase(HashToken(token));
}

// A search by the hash reveals nothing about the token.
std::optional<std::string> AccessControl::FindLent(const std::string& token) const {
  const MutexLock lock(mutex_);
  const auto found = lent_.find(HashToken(token));
  return found == lent_.end() ? std::nullopt : std::optional(found->second);
}

absl::StatusOr<std::string> AccessControl::IdentityOfToken(const Credentials& credentials) const {
  const std::string& header = credentials.authorizations.front();
  if (credentials.authorizations.size() > 1 ||
      !absl::EqualsIgnoreCase(header.substr(0, kBearerSize), "Bearer ")) {
    return Unauthenticated("BAD_TOKEN", "authorization must be one \"Bearer TOKEN\"");
  }
  std::shared_ptr<const TokenBook> tokens;
  {
    const MutexLock lock(mutex_);
    tokens = tokens_;
  }
  auto identity = tokens->Find(header.substr(kBearerSize));
  if (!identity) identity = FindLent(header.substr(kBearerSize));
  if (!identity) {
    return Unauthenticated("BAD_TOKEN", "this server does not know the token");
  }
  return *std::move(identity);
}

absl::StatusOr<std::string> AccessControl::IdentityOfCertificate(
    const Credentials& credentials) const {
  HOMING_RETURN_IF_ERROR(CheckCertificate(credentials.certificate_pem));
  return IdentityOfUris(credentials.uris);
}

absl::StatusOr<Caller> AccessControl::Identify(const Credentials& credentials) const {
  if (is_open_) {
    return Caller{"", Role::kAdmin};
  }
  const bool has_certificate = certificates_ && !credentials.certificate_pem.empty();
  const bool has_token = !credentials.authorizations.empty();
  if (!has_certificate && !has_token) {
    return Unauthenticated("NO_CREDENTIALS",
                           "no credentials: send a client certificate or a bearer token");
  }
  Caller caller;
  if (has_certificate) {
    HOMING_ASSIGN_OR_RETURN(caller.identity, IdentityOfCertificate(credentials));
  }
  if (has_token) {
    HOMING_ASSIGN_OR_RETURN(std::string identity, IdentityOfToken(credentials));
    if (has_certificate && identity != caller.identity) {
      return Unauthenticated("BAD_TOKEN", "token and certificate are of different identities");
    }
    caller.identity = std::move(identity);
  }
  const MutexLock lock(mutex_);
  caller.role = roles_->Find(caller.identity);
  return caller;
}

}  // namespace homing::server
