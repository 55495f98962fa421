#include "client/server_list.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/socket.h>

#include <array>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr char kDns[] = "dns:///";

// Numeric, with the port; empty: the name has no address of this family.
absl::StatusOr<std::string> NumericAddress(const std::string& server, int family) {
  HOMING_ASSIGN_OR_RETURN(const HostPort parsed, ParseHostPort("--server", server, 1));
  addrinfo hints{};
  hints.ai_family = family;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(parsed.host.c_str(), nullptr, &hints, &found);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owned(error == 0 ? found : nullptr,
                                                             &::freeaddrinfo);
  std::array<char, NI_MAXHOST> text{};
  if (error != 0 ||
      ::getnameinfo(found->ai_addr, found->ai_addrlen, text.data(),
                    static_cast<socklen_t>(text.size()), nullptr, 0, NI_NUMERICHOST) != 0) {
    return std::string();
  }
  return family == AF_INET6 ? absl::StrCat("[", text.data(), "]:", parsed.port)
                            : absl::StrCat(text.data(), ":", parsed.port);
}

}  // namespace

std::vector<std::string> ServersOf(const std::string& address) {
  return absl::StrSplit(absl::StripPrefix(address, kDns), ',');
}

bool MayBeMany(const std::string& address) {
  return absl::StartsWith(address, kDns) || absl::StrContains(address, ",");
}

absl::StatusOr<std::string> ChannelTarget(const std::string& address) {
  if (!absl::StrContains(address, ",")) return address;
  // gRPC takes a list of addresses of one family.
  for (const int family : {AF_INET, AF_INET6}) {
    std::vector<std::string> numeric;
    for (const std::string& server : ServersOf(address)) {
      HOMING_ASSIGN_OR_RETURN(numeric.emplace_back(), NumericAddress(server, family));
      if (numeric.back().empty()) break;
    }
    if (!numeric.back().empty()) {
      return absl::StrCat(family == AF_INET ? "ipv4:" : "ipv6:", absl::StrJoin(numeric, ","));
    }
  }
  return absl::UnavailableError(
      absl::StrCat("--server: the servers of ", address,
                   " must all have an IPv4 address, or all an IPv6 address"));
}

}  // namespace homing::client
