#include "server/config/health_check.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <sstream>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "homing/base/status_macros.h"

namespace homing::server {
namespace {

constexpr std::chrono::seconds kTimeout{3};

absl::StatusOr<std::string> ReadPem(const char* flag, const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!path.empty() && !file) {
    return absl::InvalidArgumentError(
        absl::StrCat(flag, " is \"", path, "\"; the file cannot be read"));
  }
  return text.str();
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
