#include "server/access/key_pair.h"

#include <openssl/err.h>
#include <openssl/pem.h>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"
#include "server/access/openssl_handle.h"

namespace homing::server {
namespace {

absl::Status NotAPair(const std::string& flag, const std::string& path, const std::string& what) {
  ERR_clear_error();
  return FlagFileError(flag, path, what);
}

}  // namespace

absl::Status CheckKeyPair(const std::string& certificate_file, const std::string& key_file) {
  HOMING_ASSIGN_OR_RETURN(const std::string certificate_pem,
                          ReadFlagFile("tls-cert", certificate_file));
  HOMING_ASSIGN_OR_RETURN(const std::string key_pem, ReadFlagFile("tls-key", key_file));
  const OpensslPtr<X509> certificate(
      PEM_read_bio_X509(ReadingBio(certificate_pem).get(), nullptr, nullptr, nullptr));
  if (!certificate) {
    return NotAPair("tls-cert", certificate_file, "it holds no certificate (PEM)");
  }
  const OpensslPtr<EVP_PKEY> key(
      PEM_read_bio_PrivateKey(ReadingBio(key_pem).get(), nullptr, nullptr, nullptr));
  if (!key) {
    return NotAPair("tls-key", key_file, "it holds no private key (PEM, without a pass phrase)");
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    return NotAPair("tls-key", key_file, "it is not the key of tls-cert");
  }
  return absl::OkStatus();
}

}  // namespace homing::server
