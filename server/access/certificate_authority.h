// A certificate authority for tests, and for a fleet that has none. RFC 5280 by OpenSSL.
#ifndef SERVER_ACCESS_CERTIFICATE_AUTHORITY_H_
#define SERVER_ACCESS_CERTIFICATE_AUTHORITY_H_

#include <chrono>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/access/openssl_handle.h"

namespace homing::server {

// PEM.
struct KeyAndCertificate {
  std::string key;
  std::string certificate;
};

struct CertificateRequest {
  std::string common_name;
  // As OpenSSL writes them: "URI:homing:robots/r1", "DNS:localhost", "IP:127.0.0.1".
  std::vector<std::string> names;
  // The certificate is for a server, else for a client.
  bool is_server = false;
  // Start of its validity from now on; negative: in the past.
  std::chrono::seconds begins_in{-300};
  std::chrono::seconds ends_in = std::chrono::hours(24 * 365);
};

// Keys are P-256. INTERNAL: OpenSSL fails. Not thread-safe.
class CertificateAuthority {
 public:
  // Makes an authority with a new key.
  static absl::StatusOr<CertificateAuthority> Make(const std::string& common_name,
                                                   std::chrono::seconds lifetime);
  // INVALID_ARGUMENT: not PEM, or the key of another certificate.
  static absl::StatusOr<CertificateAuthority> FromPem(const KeyAndCertificate& pem);

  // The same key and name with a new certificate that ends `lifetime` from now: certificates that
  // the old one signed stay valid.
  absl::Status Renew(std::chrono::seconds lifetime);

  absl::StatusOr<KeyAndCertificate> pem() const;
  // INVALID_ARGUMENT: OpenSSL does not accept a name.
  absl::StatusOr<KeyAndCertificate> Issue(const CertificateRequest& request) const;
  // A revocation list (PEM) that is valid for `lifetime`. It holds the entries of `previous` (PEM;
  // may be empty) and `revoked` (PEM certificates). INVALID_ARGUMENT: not PEM.
  absl::StatusOr<std::string> Revoke(const std::string& previous,
                                     const std::vector<std::string>& revoked,
                                     std::chrono::seconds lifetime) const;

 private:
  CertificateAuthority(OpensslPtr<EVP_PKEY> key, OpensslPtr<X509> certificate)
      : key_(std::move(key)), certificate_(std::move(certificate)) {}

  OpensslPtr<EVP_PKEY> key_;
  OpensslPtr<X509> certificate_;
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_CERTIFICATE_AUTHORITY_H_
