#include "server/access/tls_files.h"

#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"
#include "server/access/openssl_handle.h"

namespace homing::server {
namespace {

absl::Status Refusal(const std::string& flag, const std::string& path, const std::string& what) {
  ERR_clear_error();
  return FlagFileError(flag, path, what);
}

// The first certificate. An error: there is none, or what follows is not PEM.
absl::StatusOr<OpensslPtr<X509>> FirstCertificate(const std::string& flag, const std::string& path,
                                                  const std::string& pem) {
  const OpensslPtr<BIO> bio = ReadingBio(pem);
  OpensslPtr<X509> first(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
  if (!first) return Refusal(flag, path, "it holds no certificate (PEM)");
  while (OpensslPtr<X509>(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr))) {
  }
  const auto error = ERR_peek_last_error();
  if (ERR_GET_LIB(error) != ERR_LIB_PEM || ERR_GET_REASON(error) != PEM_R_NO_START_LINE) {
    return Refusal(flag, path, "one of its certificates is damaged or incomplete");
  }
  ERR_clear_error();
  return first;
}

absl::Status SystemError(const char* what) {
  return absl::UnavailableError(
      absl::StrCat("a copy of the TLS files cannot be ", what, ": ", std::strerror(errno)));
}

}  // namespace

absl::StatusOr<std::unique_ptr<TlsFiles>> TlsFiles::Open(std::string certificate, std::string key,
                                                         std::string client_ca) {
  std::unique_ptr<TlsFiles> files(
      new TlsFiles({std::move(certificate), std::move(key), std::move(client_ca)}));
  HOMING_RETURN_IF_ERROR(files->Reload());
  return files;
}

absl::StatusOr<TlsFiles::Contents> TlsFiles::Read() const {
  Contents read;
  HOMING_ASSIGN_OR_RETURN(read[kCertificate], ReadFlagFile("tls-cert", paths_[kCertificate]));
  HOMING_ASSIGN_OR_RETURN(read[kKey], ReadFlagFile("tls-key", paths_[kKey]));
  HOMING_ASSIGN_OR_RETURN(const auto certificate,
                          FirstCertificate("tls-cert", paths_[kCertificate], read[kCertificate]));
  const OpensslPtr<EVP_PKEY> key(
      PEM_read_bio_PrivateKey(ReadingBio(read[kKey]).get(), nullptr, nullptr, nullptr));
  if (!key) {
    return Refusal("tls-key", paths_[kKey], "it holds no private key (PEM, without a pass phrase)");
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    return Refusal("tls-key", paths_[kKey], "it is not the key of tls-cert");
  }
  if (!paths_[kClientCa].empty()) {
    HOMING_ASSIGN_OR_RETURN(read[kClientCa], ReadFlagFile("tls-client-ca", paths_[kClientCa]));
    HOMING_RETURN_IF_ERROR(
        FirstCertificate("tls-client-ca", paths_[kClientCa], read[kClientCa]).status());
  }
  return read;
}

absl::Status TlsFiles::Reload() {
  HOMING_ASSIGN_OR_RETURN(Contents read, Read());
  const MutexLock lock(mutex_);
  for (const File file : {kCertificate, kKey, kClientCa}) {
    if (read[file] == contents_[file]) continue;
    HOMING_RETURN_IF_ERROR(Replace(file, read[file]));
    contents_[file] = std::move(read[file]);
  }
  return absl::OkStatus();
}

// Whoever opens the copy's path sees the old content or the new one, whole.
absl::Status TlsFiles::Replace(File file, const std::string& content) {
  const int copy = ::memfd_create("homing-tls", MFD_CLOEXEC);
  if (copy < 0) return SystemError("made");
  if (::write(copy, content.data(), content.size()) != static_cast<ssize_t>(content.size())) {
    ::close(copy);
    return SystemError("written");
  }
  if (copies_[file] < 0) {
    copies_[file] = copy;
    return absl::OkStatus();
  }
  const int replaced = ::dup3(copy, copies_[file], O_CLOEXEC);
  ::close(copy);
  return replaced < 0 ? SystemError("replaced") : absl::OkStatus();
}

std::string TlsFiles::PathOf(File file) const {
  return absl::StrCat("/proc/self/fd/", copies_[file]);
}

}  // namespace homing::server
