#include "server/access/certificate_authority.h"

#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"

namespace homing::server {
namespace {

constexpr int kSerialBits = 127;

absl::Status Failed(const char* what) {
  ERR_clear_error();
  return absl::InternalError(absl::StrCat("OpenSSL cannot make ", what));
}

absl::Status NotPem(const char* what) {
  ERR_clear_error();
  return absl::InvalidArgumentError(absl::StrCat(what, " is not PEM"));
}

absl::StatusOr<std::string> CertificateToPem(X509* certificate) {
  const OpensslPtr<BIO> bio(BIO_new(BIO_s_mem()));
  if (PEM_write_bio_X509(bio.get(), certificate) != 1) {
    return Failed("PEM");
  }
  return ContentsOf(bio.get());
}

absl::StatusOr<KeyAndCertificate> ToPem(EVP_PKEY* key, X509* certificate) {
  KeyAndCertificate pem;
  HOMING_ASSIGN_OR_RETURN(pem.certificate, CertificateToPem(certificate));
  const OpensslPtr<BIO> bio(BIO_new(BIO_s_mem()));
  if (PEM_write_bio_PrivateKey(bio.get(), key, nullptr, nullptr, 0, nullptr, nullptr) != 1) {
    return Failed("PEM");
  }
  pem.key = ContentsOf(bio.get());
  return pem;
}

OpensslPtr<X509> CertificateFromPem(const std::string& pem) {
  return OpensslPtr<X509>(PEM_read_bio_X509(ReadingBio(pem).get(), nullptr, nullptr, nullptr));
}

// Sets a random serial number, so that no two certificates share one.
bool SetSerial(X509* certificate) {
  BIGNUM* serial = BN_new();
  const bool set = BN_rand(serial, kSerialBits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) == 1 &&
                   BN_to_ASN1_INTEGER(serial, X509_get_serialNumber(certificate)) != nullptr;
  BN_free(serial);
  return set;
}

bool AddExtension(X509* certificate, X509* issuer, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
  const bool added = extension != nullptr && X509_add_ext(certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  return added;
}

// A certificate with names, dates and key, but without issuer and extensions.
OpensslPtr<X509> Blank(const CertificateRequest& request, EVP_PKEY* key) {
  OpensslPtr<X509> certificate(X509_new());
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  const auto* name = reinterpret_cast<const unsigned char*>(request.common_name.data());
  const bool made =
      X509_set_version(certificate.get(), X509_VERSION_3) == 1 && SetSerial(certificate.get()) &&
      X509_gmtime_adj(X509_getm_notBefore(certificate.get()), request.begins_in.count()) !=
          nullptr &&
      X509_gmtime_adj(X509_getm_notAfter(certificate.get()), request.ends_in.count()) != nullptr &&
      X509_set_pubkey(certificate.get(), key) == 1 &&
      X509_NAME_add_entry_by_NID(subject, NID_commonName, MBSTRING_UTF8, name,
                                 static_cast<int>(request.common_name.size()), -1, 0) == 1;
  return made ? std::move(certificate) : nullptr;
}

bool Sign(X509* certificate, X509* issuer, EVP_PKEY* issuer_key) {
  return X509_set_issuer_name(certificate, X509_get_subject_name(issuer)) == 1 &&
         AddExtension(certificate, issuer, NID_subject_key_identifier, "hash") &&
         AddExtension(certificate, issuer, NID_authority_key_identifier, "keyid") &&
         X509_sign(certificate, issuer_key, EVP_sha256()) > 0;
}

absl::Status SignItself(X509* certificate, EVP_PKEY* key) {
  const bool made =
      certificate != nullptr &&
      AddExtension(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE") &&
      AddExtension(certificate, certificate, NID_key_usage, "critical,keyCertSign,cRLSign") &&
      Sign(certificate, certificate, key);
  return made ? absl::OkStatus() : Failed("a certificate");
}

bool AddRevoked(X509_CRL* list, const ASN1_INTEGER* serial, const ASN1_TIME* now) {
  X509_REVOKED* entry = X509_REVOKED_new();
  return X509_REVOKED_set_serialNumber(entry, const_cast<ASN1_INTEGER*>(serial)) == 1 &&
         X509_REVOKED_set_revocationDate(entry, const_cast<ASN1_TIME*>(now)) == 1 &&
         X509_CRL_add0_revoked(list, entry) == 1;
}

// Copies the serial numbers of an existing list.
absl::Status AddPrevious(const std::string& pem, X509_CRL* list) {
  const OpensslPtr<X509_CRL> previous(
      PEM_read_bio_X509_CRL(ReadingBio(pem).get(), nullptr, nullptr, nullptr));
  if (!previous) {
    return NotPem("the revocation list");
  }
  STACK_OF(X509_REVOKED)* entries = X509_CRL_get_REVOKED(previous.get());
  for (int i = 0; i < sk_X509_REVOKED_num(entries); ++i) {
    const X509_REVOKED* entry = sk_X509_REVOKED_value(entries, i);
    if (!AddRevoked(list, X509_REVOKED_get0_serialNumber(entry),
                    X509_REVOKED_get0_revocationDate(entry))) {
      return Failed("a revocation list");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<CertificateAuthority> CertificateAuthority::Make(const std::string& common_name,
                                                                std::chrono::seconds lifetime) {
  OpensslPtr<EVP_PKEY> key(EVP_EC_gen("P-256"));
  CertificateRequest request;
  request.common_name = common_name;
  request.ends_in = lifetime;
  OpensslPtr<X509> certificate = Blank(request, key.get());
  HOMING_RETURN_IF_ERROR(SignItself(certificate.get(), key.get()));
  return CertificateAuthority(std::move(key), std::move(certificate));
}

absl::Status CertificateAuthority::Renew(std::chrono::seconds lifetime) {
  CertificateRequest request;
  request.ends_in = lifetime;
  // The subject is copied below: Blank needs some name.
  request.common_name = "renewed";
  OpensslPtr<X509> renewed = Blank(request, key_.get());
  if (!renewed ||
      X509_set_subject_name(renewed.get(), X509_get_subject_name(certificate_.get())) != 1) {
    return Failed("a certificate");
  }
  HOMING_RETURN_IF_ERROR(SignItself(renewed.get(), key_.get()));
  certificate_ = std::move(renewed);
  return absl::OkStatus();
}

absl::StatusOr<CertificateAuthority> CertificateAuthority::FromPem(const KeyAndCertificate& pem) {
  OpensslPtr<X509> certificate = CertificateFromPem(pem.certificate);
  OpensslPtr<EVP_PKEY> key(
      PEM_read_bio_PrivateKey(ReadingBio(pem.key).get(), nullptr, nullptr, nullptr));
  if (!certificate || !key) {
    return NotPem("the authority's key or certificate");
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    ERR_clear_error();
    return absl::InvalidArgumentError("the authority's key is of another certificate");
  }
  return CertificateAuthority(std::move(key), std::move(certificate));
}

absl::StatusOr<KeyAndCertificate> CertificateAuthority::pem() const {
  return ToPem(key_.get(), certificate_.get());
}

absl::StatusOr<KeyAndCertificate> CertificateAuthority::Issue(
    const CertificateRequest& request) const {
  const OpensslPtr<EVP_PKEY> key(EVP_EC_gen("P-256"));
  const OpensslPtr<X509> certificate = Blank(request, key.get());
  X509* const made = certificate.get();
  X509* const issuer = certificate_.get();
  const char* usage = request.is_server ? "serverAuth" : "clientAuth";
  if (!certificate || !AddExtension(made, issuer, NID_basic_constraints, "critical,CA:FALSE") ||
      !AddExtension(made, issuer, NID_key_usage, "critical,digitalSignature") ||
      !AddExtension(made, issuer, NID_ext_key_usage, usage)) {
    return Failed("a certificate");
  }
  const std::string names = absl::StrJoin(request.names, ",");
  if (!names.empty() && !AddExtension(made, issuer, NID_subject_alt_name, names)) {
    ERR_clear_error();
    return TextMustBe("names", names, "X.509 names");
  }
  if (!Sign(made, issuer, key_.get())) {
    return Failed("a certificate");
  }
  return ToPem(key.get(), made);
}

absl::StatusOr<std::string> CertificateAuthority::Revoke(const std::string& previous,
                                                         const std::vector<std::string>& revoked,
                                                         std::chrono::seconds lifetime) const {
  const OpensslPtr<X509_CRL> list(X509_CRL_new());
  ASN1_TIME* const now = X509_gmtime_adj(nullptr, 0);
  const std::unique_ptr<ASN1_TIME, decltype(&ASN1_TIME_free)> owned(now, &ASN1_TIME_free);
  X509_CRL_set_version(list.get(), X509_CRL_VERSION_2);
  X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(certificate_.get()));
  X509_CRL_set1_lastUpdate(list.get(), now);
  HOMING_RETURN_IF_ERROR(previous.empty() ? absl::OkStatus() : AddPrevious(previous, list.get()));
  for (const std::string& pem : revoked) {
    const OpensslPtr<X509> certificate = CertificateFromPem(pem);
    if (!certificate) {
      return NotPem("the certificate to revoke");
    }
    AddRevoked(list.get(), X509_get0_serialNumber(certificate.get()), now);
  }
  ASN1_TIME* const next = X509_gmtime_adj(nullptr, lifetime.count());
  X509_CRL_set1_nextUpdate(list.get(), next);
  ASN1_TIME_free(next);
  const OpensslPtr<BIO> bio(BIO_new(BIO_s_mem()));
  if (X509_CRL_sort(list.get()) != 1 || X509_CRL_sign(list.get(), key_.get(), EVP_sha256()) <= 0 ||
      PEM_write_bio_X509_CRL(bio.get(), list.get()) != 1) {
    return Failed("a revocation list");
  }
  return ContentsOf(bio.get());
}

}  // namespace homing::server
