// Checks that a client's certificate is valid now: signed by our CA, within its dates, not revoked.
// OpenSSL does it by RFC 5280.
#ifndef SERVER_ACCESS_CLIENT_CERTIFICATES_H_
#define SERVER_ACCESS_CLIENT_CERTIFICATES_H_

#include <memory>
#include <string>
#include <unordered_map>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "server/access/openssl_handle.h"

namespace homing::server {

// The TLS handshake and each call check the certificate, so that one that is revoked or expires
// during a connection is refused too. Thread-safe.
class ClientCertificates {
 public:
  // `ca_file`: the trusted CAs, PEM. `crl_dir`: a folder of revocation lists; empty: none are
  // checked. With a folder, certificates of an issuer whose list is missing or outdated are
  // refused. INVALID_ARGUMENT: a file cannot be read or holds no certificate, or the folder holds
  // no list.
  static absl::StatusOr<std::unique_ptr<ClientCertificates>> Open(const std::string& ca_file,
                                                                  const std::string& crl_dir);

  // Reads the files again. After an error the previous ones stay in use. Errors as Open.
  absl::Status Reload();

  // `chain_pem`: the client's certificate first. UNAUTHENTICATED, with OpenSSL's reason.
  absl::Status Check(const std::string& chain_pem) const;

 private:
  ClientCertificates(const std::string& ca_file, const std::string& crl_dir)
      : ca_file_(ca_file), crl_dir_(crl_dir) {}
  absl::Status Verify(X509_STORE* store, const std::string& chain_pem) const;

  const std::string ca_file_;
  const std::string crl_dir_;
  mutable Mutex mutex_;
  std::shared_ptr<X509_STORE> store_ HOMING_GUARDED_BY(mutex_);
  // Results of Verify since the last Reload.
  mutable std::unordered_map<std::string, absl::Status> known_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_CLIENT_CERTIFICATES_H_
