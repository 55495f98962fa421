// When the certificates and revocation lists in use end.
#ifndef SERVER_ACCESS_CERTIFICATE_EXPIRY_H_
#define SERVER_ACCESS_CERTIFICATE_EXPIRY_H_

#include <cstdint>
#include <string>
#include <vector>

namespace homing::server {

// Paths; empty: not used.
struct CertificateFiles {
  std::string certificate;
  std::string client_ca;
  std::string crl_dir;
};

struct CertificateExpiry {
  // The option that names the file, and the file.
  std::string flag;
  std::string path;
  // Seconds since 1970: the earliest end of the certificates or lists in the file.
  std::int64_t end_s = 0;
};

// Reads all files. Returns one entry a file; files that cannot be read are left out.
std::vector<CertificateExpiry> ReadExpiries(const CertificateFiles& files);

// A text for the operator when `expiry` is less than 30 days away at `now_s`, or past; else empty.
std::string ExpiryWarning(const CertificateExpiry& expiry, std::int64_t now_s);

}  // namespace homing::server

#endif  // SERVER_ACCESS_CERTIFICATE_EXPIRY_H_
