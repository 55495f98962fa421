#include "server/access/client_certificates.h"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <filesystem>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

// Chains whose result is cached between two reloads; others are verified each time.
constexpr std::size_t kMostKnown = 10'000;

absl::StatusOr<OpensslPtr<STACK_OF(X509_INFO)>> ReadPem(const std::string& flag,
                                                        const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(const std::string pem, ReadFlagFile(flag, path));
  OpensslPtr<STACK_OF(X509_INFO)> items(
      PEM_X509_INFO_read_bio(ReadingBio(pem).get(), nullptr, nullptr, nullptr));
  ERR_clear_error();
  if (!items) {
    return FlagFileError(flag, path, "is not PEM");
  }
  return items;
}

absl::Status AddAuthorities(const std::string& path, X509_STORE* store) {
  HOMING_ASSIGN_OR_RETURN(const auto items, ReadPem("tls-client-ca", path));
  int found = 0;
  for (int i = 0; i < sk_X509_INFO_num(items.get()); ++i) {
    if (X509* certificate = sk_X509_INFO_value(items.get(), i)->x509; certificate != nullptr) {
      found += X509_STORE_add_cert(store, certificate);
    }
  }
  return found > 0 ? absl::OkStatus()
                   : FlagFileError("tls-client-ca", path, "holds no certificate");
}

absl::StatusOr<int> AddRevocations(const std::string& path, X509_STORE* store) {
  HOMING_ASSIGN_OR_RETURN(const auto items, ReadPem("tls-crl-dir", path));
  int found = 0;
  for (int i = 0; i < sk_X509_INFO_num(items.get()); ++i) {
    if (X509_CRL* list = sk_X509_INFO_value(items.get(), i)->crl; list != nullptr) {
      found += X509_STORE_add_crl(store, list);
    }
  }
  return found;
}

absl::Status AddRevocationFolder(const std::string& folder, X509_STORE* store) {
  std::error_code error;
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) {
      HOMING_ASSIGN_OR_RETURN(const int lists, AddRevocations(entry.path().string(), store));
      found += lists;
    }
  }
  if (error || found == 0) {
    return FlagFileError("tls-crl-dir", folder,
                         "must be a folder that holds a revocation list (PEM)");
  }
  X509_STORE_set_flags(store, X509_V_FLAG_CRL_CHECK | X509_V_FLAG_CRL_CHECK_ALL);
  return absl::OkStatus();
}

absl::Status Refusal(const std::string& why) {
  return WithReason(
      absl::UnauthenticatedError(absl::StrCat("the client's certificate is refused: ", why)),
      {"BAD_CERTIFICATE", {}});
}

}  // namespace

absl::StatusOr<std::unique_ptr<ClientCertificates>> ClientCertificates::Open(
    const std::string& ca_file, const std::string& crl_dir) {
  std::unique_ptr<ClientCertificates> opened(new ClientCertificates(ca_file, crl_dir));
  HOMING_RETURN_IF_ERROR(opened->Reload());
  return opened;
}

absl::Status ClientCertificates::Reload() {
  std::shared_ptr<X509_STORE> store(X509_STORE_new(), OpensslFree());
  X509_STORE_set_purpose(store.get(), X509_PURPOSE_SSL_CLIENT);
  absl::Status status = AddAuthorities(ca_file_, store.get());
  if (status.ok() && !crl_dir_.empty()) {
    status = AddRevocationFolder(crl_dir_, store.get());
  }
  const MutexLock lock(mutex_);
  known_.clear();
  if (status.ok()) {
    store_ = std::move(store);
  }
  return status;
}

absl::Status ClientCertificates::Check(const std::string& chain_pem) const {
  std::shared_ptr<X509_STORE> store;
  {
    const MutexLock lock(mutex_);
    if (const auto found = known_.find(chain_pem); found != known_.end()) {
      return found->second;
    }
    store = store_;
  }
  absl::Status status = Verify(store.get(), chain_pem);
  const MutexLock lock(mutex_);
  if (store == store_ && known_.size() < kMostKnown) {
    known_.emplace(chain_pem, status);
  }
  return status;
}

absl::Status ClientCertificates::Verify(X509_STORE* store, const std::string& chain_pem) const {
  const OpensslPtr<BIO> bio = ReadingBio(chain_pem);
  const OpensslPtr<X509> leaf(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
  const OpensslPtr<STACK_OF(X509)> others(sk_X509_new_null());
  while (X509* other = PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)) {
    sk_X509_push(others.get(), other);
  }
  ERR_clear_error();
  const OpensslPtr<X509_STORE_CTX> context(X509_STORE_CTX_new());
  if (!leaf || !context ||
      X509_STORE_CTX_init(context.get(), store, leaf.get(), others.get()) != 1) {
    return Refusal("it cannot be read");
  }
  if (X509_verify_cert(context.get()) != 1) {
    ERR_clear_error();
    return Refusal(X509_verify_cert_error_string(X509_STORE_CTX_get_error(context.get())));
  }
  return absl::OkStatus();
}

}  // namespace homing::server
