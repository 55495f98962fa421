// Several servers behind one address: a list, or a name with many addresses.
#ifndef CLIENT_SERVER_LIST_H_
#define CLIENT_SERVER_LIST_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace homing::client {

// The servers of "A:1,B:2", or the one of "A:1" or "dns:///A:1".
std::vector<std::string> ServersOf(const std::string& address);

// A list, or dns:///NAME:PORT, whose name may have many addresses.
bool MayBeMany(const std::string& address);

// The target for gRPC. The names of a list are resolved here, once; gRPC resolves that of dns:///
// again after each failure. UNAVAILABLE: a name cannot be resolved.
absl::StatusOr<std::string> ChannelTarget(const std::string& address);

}  // namespace homing::client

#endif  // CLIENT_SERVER_LIST_H_
