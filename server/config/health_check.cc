#include "server/config/health_check.h"

#include <grpcpp/grpcpp.h>
#include <openssl/pem.h>

#include <chrono>
#include <cstdlib>
#include <memory>

#include "absl/status/statusor.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"
#include "server/access/openssl_handle.h"

namespace homing::server {
namespace {

constexpr std::chrono::seconds kTimeout{3};

absl::StatusOr<std::string> ReadPem(const std::string& flag, const std::string& path) {
  return path.empty() ? absl::StatusOr<std::string>("") : ReadFlagFile(flag, path);
}

// A name for which the certificate is valid; empty: it has none.
std::string NameIn(const std::string& pem) {
  const OpensslPtr<X509> certificate(
      PEM_read_bio_X509(ReadingBio(pem).get(), nullptr, nullptr, nullptr));
  if (certificate == nullptr) return "";
  const OpensslPtr<GENERAL_NAMES> names(static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(certificate.get(), NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; names != nullptr && i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(names.get(), i);
    if (name->type != GEN_DNS) continue;
    return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(name->d.dNSName)),
            static_cast<std::size_t>(ASN1_STRING_length(name->d.dNSName))};
  }
  return "";
}

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeCredentials(
    const HealthCheckFiles& files, grpc::ChannelArguments* arguments) {
  if (files.ca.empty() && files.trusted.empty()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions tls;
  HOMING_ASSIGN_OR_RETURN(tls.pem_root_certs,
                          ReadPem("ca", files.ca.empty() ? files.trusted : files.ca));
  HOMING_ASSIGN_OR_RETURN(tls.pem_cert_chain, ReadPem("cert", files.cert));
  HOMING_ASSIGN_OR_RETURN(tls.pem_private_key, ReadPem("key", files.key));
  if (files.ca.empty()) {
    if (const std::string name = NameIn(tls.pem_root_certs); !name.empty()) {
      arguments->SetSslTargetNameOverride(name);
    }
  }
  return grpc::SslCredentials(tls);
}

}  // namespace

absl::Status CheckHealth(const std::string& address, const HealthCheckFiles& files) {
  if (!IsUnixSocket(address)) {
    HOMING_RETURN_IF_ERROR(ParseHostPort("server", address, 1).status());
  }
  ::setenv("GRPC_DNS_RESOLVER", "native", /*overwrite=*/0);
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  HOMING_ASSIGN_OR_RETURN(const auto credentials, MakeCredentials(files, &arguments));
  const auto stub =
      grpc::health::v1::Health::NewStub(grpc::CreateCustomChannel(address, credentials, arguments));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kTimeout);
  grpc::health::v1::HealthCheckResponse response;
  const grpc::Status status = stub->Check(&context, {}, &response);
  if (!status.ok()) {
    return absl::UnavailableError(absl::StrCat(address, ": ", status.error_message()));
  }
  if (response.status() != grpc::health::v1::HealthCheckResponse::SERVING) {
    return absl::UnavailableError(absl::StrCat(address, ": not serving"));
  }
  return absl::OkStatus();
}

}  // namespace homing::server
