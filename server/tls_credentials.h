// TLS of the server, with certificates that are reloaded while it runs.
#ifndef SERVER_TLS_CREDENTIALS_H_
#define SERVER_TLS_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "server/access/access_control.h"
#include "server/access/certificate_expiry.h"
#include "server/access/tls_files.h"
#include "server/config/server_options.h"

namespace homing::server {

// Plain text without `files`. With a client CA, the handshake also
// checks with `access`; clients without a certificate are accepted only if tokens are in use.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(
    const ServerOptions& options, const TlsFiles* files,
    std::shared_ptr<const AccessControl> access);

// The files whose ends Housekeeping and the metrics watch.
CertificateFiles CertificateFilesOf(const ServerOptions& options);

}  // namespace homing::server

#endif  // SERVER_TLS_CREDENTIALS_H_
