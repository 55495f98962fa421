#include "server/access/key_pair.h"

#include <openssl/err.h>
#include <openssl/pem.h>

#include <fstream>
#include <sstream>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "homing/status_macros.h"
#include "server/access/openssl_handle.h"

namespace homing::server {
namespace {

absl::Status Bad(const char* flag, const std::string& path, const char* what) {
  ERR_clear_error();
  return absl::InvalidArgumentError(absl::StrCat(flag, " is \"", path, "\"; ", what));
}

absl::StatusOr<std::string> Read(const char* flag, const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    return Bad(flag, path, "the file cannot be read");
  }
  return text.str();
}

}  // namespace

absl::Status CheckKeyPair(const std::string& certificate_file, const std::string& key_file) {
  HOMING_ASSIGN_OR_RETURN(const std::string certificate_pem, Read("tls-cert", certificate_file));
  HOMING_ASSIGN_OR_RETURN(const std::string key_pem, Read("tls-key", key_file));
  const OpensslPtr<X509> certificate(
      PEM_read_bio_X509(ReadingBio(certificate_pem).get(), nullptr, nullptr, nullptr));
  if (!certificate) {
    return Bad("tls-cert", certificate_file, "it holds no certificate (PEM)");
  }
  const OpensslPtr<EVP_PKEY> key(
      PEM_read_bio_PrivateKey(ReadingBio(key_pem).get(), nullptr, nullptr, nullptr));
  if (!key) {
    return Bad("tls-key", key_file, "it holds no private key (PEM, without a pass phrase)");
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    return Bad("tls-key", key_file, "it is not the key of tls-cert");
  }
  return absl::OkStatus();
}

}  // namespace homing::server
