// Where a server is, and why nothing answers there.
#ifndef CLIENT_SERVER_ADDRESS_H_
#define CLIENT_SERVER_ADDRESS_H_

#include <string>

#include "absl/status/status.h"

namespace homing::client {

// HOST:PORT, a list of them with commas, dns:///HOST:PORT, or unix:PATH. INVALID_ARGUMENT.
absl::Status CheckServerAddress(const std::string& address);

// The proxy that gRPC takes from the environment (grpc_proxy, https_proxy, http_proxy), as
// "VARIABLE (URL)"; empty: none.
std::string ProxyOfEnvironment();

// Whether the way to the address may lead through such a proxy: not to this machine, to private
// addresses, or to names without a point or of .local. May ask the name service.
bool MayUseProxy(const std::string& address);

// UNAVAILABLE with the reason why no connection comes about: a name that cannot be resolved, a
// proxy in between, nothing that listens, one side with TLS and the other without, or certificates.
// Connects once more to find out.
absl::Status ExplainUnreachable(const std::string& address, bool uses_tls);

}  // namespace homing::client

#endif  // CLIENT_SERVER_ADDRESS_H_
