// The folder that `homing-server certs` keeps.
#ifndef SERVER_ACCESS_CERTIFICATE_FOLDER_H_
#define SERVER_ACCESS_CERTIFICATE_FOLDER_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace homing::server {

struct CertificateOrder {
  // Created if missing. An authority in it is used again.
  std::string folder;
  // Ids; each gets a certificate with URI:homing:robots/ID or URI:homing:operators/ID.
  std::vector<std::string> robots;
  std::vector<std::string> operators;
  // Names or addresses of the server besides localhost, 127.0.0.1 and ::1.
  std::vector<std::string> hosts;
  // Identities ("robots/r1") whose certificates in the folder are to be revoked.
  std::vector<std::string> revoked;
  // How long the certificates of the server, robots and operators are valid. [1, 36500].
  int days = 365;
  // How long the authority's own certificate and the revocation list are valid. Each run
  // makes the list again, so it must last until the next run. [1, 36500].
  int ca_days = 3650;
  // Make a new certificate for the authority's key. Certificates that it signed stay valid.
  bool renew_ca = false;
};

// Writes ca.pem and ca.key; server.pem and server.key (new if hosts are given); robots/ID.pem and
// .key; operators/ID.pem and .key; crl/homing.pem (new each time). Keys have mode 0600. Returns the
// paths written. INVALID_ARGUMENT naming the field.
absl::StatusOr<std::vector<std::string>> MakeCertificates(const CertificateOrder& order);

}  // namespace homing::server

#endif  // SERVER_ACCESS_CERTIFICATE_FOLDER_H_
