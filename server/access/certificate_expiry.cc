#include "server/access/certificate_expiry.h"

#include <openssl/asn1.h>
#include <openssl/err.h>
#include <openssl/pem.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <optional>

#include "absl/strings/str_cat.h"
#include "server/access/flag_file.h"
#include "server/access/openssl_handle.h"

namespace homing::server {
namespace {

constexpr std::int64_t kDayS = 86'400;
constexpr std::int64_t kWarnS = 30 * kDayS;

std::optional<std::int64_t> SecondsOf(const ASN1_TIME* time) {
  std::tm parts{};
  if (time == nullptr || ASN1_TIME_to_tm(time, &parts) != 1) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(timegm(&parts));
}

void AddFile(const std::string& flag, const std::string& path,
             std::vector<CertificateExpiry>* expiries) {
  const std::string pem = ReadFlagFile(flag, path).value_or("");
  const OpensslPtr<STACK_OF(X509_INFO)> items(
      PEM_X509_INFO_read_bio(ReadingBio(pem).get(), nullptr, nullptr, nullptr));
  ERR_clear_error();
  std::optional<std::int64_t> first;
  for (int i = 0; items && i < sk_X509_INFO_num(items.get()); ++i) {
    const X509_INFO* item = sk_X509_INFO_value(items.get(), i);
    for (const ASN1_TIME* time :
         {item->x509 != nullptr ? X509_get0_notAfter(item->x509) : nullptr,
          item->crl != nullptr ? X509_CRL_get0_nextUpdate(item->crl) : nullptr}) {
      if (const auto end = SecondsOf(time)) {
        first = std::min(first.value_or(*end), *end);
      }
    }
  }
  if (first) {
    expiries->push_back({flag, path, *first});
  }
}

}  // namespace

std::vector<CertificateExpiry> ReadExpiries(const CertificateFiles& files) {
  std::vector<CertificateExpiry> expiries;
  if (!files.certificate.empty()) {
    AddFile("tls-cert", files.certificate, &expiries);
  }
  if (!files.client_ca.empty()) {
    AddFile("tls-client-ca", files.client_ca, &expiries);
  }
  std::error_code error;
  if (!files.crl_dir.empty()) {
    for (const auto& entry : std::filesystem::directory_iterator(files.crl_dir, error)) {
      AddFile("tls-crl-dir", entry.path().string(), &expiries);
    }
  }
  return expiries;
}

std::string ExpiryWarning(const CertificateExpiry& expiry, std::int64_t now_s) {
  const std::int64_t left_s = expiry.end_s - now_s;
  if (left_s >= kWarnS) {
    return "";
  }
  if (left_s <= 0) {
    return absl::StrCat(expiry.flag, ": ", expiry.path, " has expired; connections are refused");
  }
  return absl::StrCat(expiry.flag, ": ", expiry.path, " ends in ", left_s / kDayS,
                      " days; renew it (homing-server certs)");
}

}  // namespace homing::server
