#include "server/config/health_check.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>

#include "absl/status/statusor.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"

namespace homing::server {
namespace {

constexpr std::chrono::seconds kTimeout{3};

absl::StatusOr<std::string> ReadPem(const std::string& flag, const std::string& path) {
  return path.empty() ? absl::StatusOr<std::string>("") : ReadFlagFile(flag, path);
}

}  // namespace

absl::Status CheckHealth(const std::string& address, const std::string& ca_file,
                         const std::string& cert_file, const std::string& key_file) {
  std::shared_ptr<grpc::ChannelCredentials> credentials = grpc::InsecureChannelCredentials();
  if (!ca_file.empty()) {
    grpc::SslCredentialsOptions tls;
    HOMING_ASSIGN_OR_RETURN(tls.pem_root_certs, ReadPem("ca", ca_file));
    HOMING_ASSIGN_OR_RETURN(tls.pem_cert_chain, ReadPem("cert", cert_file));
    HOMING_ASSIGN_OR_RETURN(tls.pem_private_key, ReadPem("key", key_file));
    credentials = grpc::SslCredentials(tls);
  }
  const auto stub = grpc::health::v1::Health::NewStub(grpc::CreateChannel(address, credentials));
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
