// The address of a server, and the reason why it does not answer.
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

// True if gRPC may use such a proxy for the address: not for this machine, private addresses, and
// names without a dot or of .local. May resolve the name.
bool MayUseProxy(const std::string& address);

// UNAVAILABLE with the reason why the connection fails: a name that cannot be resolved, a proxy,
// nothing that listens, TLS on one side only, or certificates. Connects once more to find it.
absl::Status ExplainUnreachable(const std::string& address, bool uses_tls);

}  // namespace homing::client

#endif  // CLIENT_SERVER_ADDRESS_H_
