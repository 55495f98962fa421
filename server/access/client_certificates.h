// Whether a client's certificate is good now: of our CA, within its dates, not revoked.
// RFC 5280 by OpenSSL.
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

// The TLS handshake asks it, and so does every call, so that a certificate that is revoked or runs
// out while its connection is open is refused as well. Thread-safe.
class ClientCertificates {
 public:
  // PEM files: the CAs to trust, and a folder of revocation lists (empty: none is asked for). With
  // a folder, an issuer whose list is missing or past its next update vouches for nobody.
  // INVALID_ARGUMENT: a file that cannot be read or holds no certificate, a folder without a list.
  static absl::StatusOr<std::unique_ptr<ClientCertificates>> Open(const std::string& ca_file,
                                                                  const std::string& crl_dir);

  // Reads the files again. When they cannot be read, the ones before stay. As Open.
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
  // What Verify said since the last Reload.
  mutable std::unordered_map<std::string, absl::Status> known_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_CLIENT_CERTIFICATES_H_
