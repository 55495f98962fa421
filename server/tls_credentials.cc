#include "server/tls_credentials.h"

#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_certificate_verifier.h>
#include <grpcpp/security/tls_credentials_options.h>

#include <string>
#include <utility>

#include "server/rpc/status_conversion.h"

namespace homing::server {
namespace {

namespace tls = grpc::experimental;

// How often gRPC looks at the copies in memory, which change at a reload.
constexpr unsigned int kLookEveryS = 1;

std::string StringOf(const grpc::string_ref& text) { return std::string(text.data(), text.size()); }

// OpenSSL has already checked chain and dates; this adds revocation.
class ClientVerifier : public tls::ExternalCertificateVerifier {
 public:
  explicit ClientVerifier(std::shared_ptr<const AccessControl> access)
      : access_(std::move(access)) {}

  bool Verify(tls::TlsCustomVerificationCheckRequest* request,
              std::function<void(grpc::Status)> /*callback*/, grpc::Status* result) override {
    // OpenSSL's chain does not hold the client's own certificate.
    const std::string pem =
        StringOf(request->peer_cert()) + StringOf(request->peer_cert_full_chain());
    // A client without a certificate needs a token in each call.
    const absl::Status status = pem.empty() ? absl::OkStatus() : access_->CheckCertificate(pem);
    *result = ToGrpcStatus(status);
    return true;
  }
  void Cancel(tls::TlsCustomVerificationCheckRequest* /*request*/) override {}

 private:
  const std::shared_ptr<const AccessControl> access_;
};

}  // namespace

std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(
    const ServerOptions& options, const TlsFiles* files,
    std::shared_ptr<const AccessControl> access) {
  if (files == nullptr) return grpc::InsecureServerCredentials();
  tls::TlsServerCredentialsOptions settings(std::make_shared<tls::FileWatcherCertificateProvider>(
      files->key(), files->certificate(), files->client_ca(), kLookEveryS));
  settings.watch_identity_key_cert_pairs();
  if (!options.tls_client_ca.empty()) {
    settings.watch_root_certs();
    settings.set_cert_request_type(options.tokens.empty()
                                       ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                                       : GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY);
    settings.set_certificate_verifier(
        tls::ExternalCertificateVerifier::Create<ClientVerifier>(std::move(access)));
  }
  return tls::TlsServerCredentials(settings);
}

CertificateFiles CertificateFilesOf(const ServerOptions& options) {
  return {options.tls_cert, options.tls_client_ca, options.tls_crl_dir};
}

}  // namespace homing::server
