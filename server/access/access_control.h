// Identifies the caller from the credentials of a call.
#ifndef SERVER_ACCESS_ACCESS_CONTROL_H_
#define SERVER_ACCESS_ACCESS_CONTROL_H_

#include <map>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "server/access/caller.h"
#include "server/access/client_certificates.h"
#include "server/access/role_book.h"
#include "server/access/token_book.h"

namespace homing::server {

// Paths; empty: not used.
struct AccessFiles {
  std::string tokens;
  std::string roles;
  std::string client_ca;
  std::string crl_dir;
};

// Thread-safe.
class AccessControl {
 public:
  // Without any file every caller is an admin. INVALID_ARGUMENT.
  static absl::StatusOr<std::unique_ptr<AccessControl>> Open(const AccessFiles& files);

  // No credentials are required.
  bool is_open() const { return is_open_; }

  // The credentials are a certificate, a token, or both of the same identity. UNAUTHENTICATED:
  // neither is given, or one is not valid now.
  absl::StatusOr<Caller> Identify(const Credentials& credentials) const;
  // As ClientCertificates::Check; OK when no client CA is set.
  absl::Status CheckCertificate(const std::string& chain_pem) const;

  // Makes a token for a login by other means, valid until WithdrawToken or the end of the process;
  // its role is that of the identity. INTERNAL: the system provides no random bits.
  absl::StatusOr<std::string> LendToken(const std::string& identity);
  void WithdrawToken(const std::string& token);

  enum class Reading { kSettled, kAtOnce };

  // Reads all files again; kSettled: those of tokens and roles only once they were unchanged for a
  // second, since one may be half written. A file that cannot be read, or holds nothing while the
  // previous one had entries, keeps its previous content. Returns the first error.
  absl::Status Reload(Reading reading);

 private:
  explicit AccessControl(const AccessFiles& files);
  absl::Status ReadTokens();
  absl::Status ReadRoles();
  absl::Status ReadFiles(Reading reading);
  // The identity that a token was lent to.
  std::optional<std::string> FindLent(const std::string& token) const;
  absl::StatusOr<std::string> IdentityOfToken(const Credentials& credentials) const;
  absl::StatusOr<std::string> IdentityOfCertificate(const Credentials& credentials) const;

  const AccessFiles files_;
  const bool is_open_;
  std::unique_ptr<ClientCertificates> certificates_;
  mutable Mutex mutex_;
  std::shared_ptr<const TokenBook> tokens_ HOMING_GUARDED_BY(mutex_) =
      std::make_shared<TokenBook>();
  std::map<TokenHash, std::string> lent_ HOMING_GUARDED_BY(mutex_);
  std::shared_ptr<const RoleBook> roles_ HOMING_GUARDED_BY(mutex_) = std::make_shared<RoleBook>();
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_ACCESS_CONTROL_H_
