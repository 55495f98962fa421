#include "client/server_address.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/server_list.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr int kProbeMs = 1000;
constexpr std::array<const char*, 3> kProxyVariables = {"grpc_proxy", "https_proxy", "http_proxy"};

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

bool IsSocketFile(const std::string& address) {
  return IsUnixSocket(address) || absl::StartsWith(address, "unix-abstract:");
}

// The system's own resolver: hosts file, mDNS and all. `error` is getaddrinfo's.
Addresses Resolve(const HostPort& target, int* error) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  *error = ::getaddrinfo(target.host.c_str(), absl::StrCat(target.port).c_str(), &hints, &found);
  return {*error == 0 ? found : nullptr, &::freeaddrinfo};
}

bool IsPrivate4(std::uint32_t address) {
  const auto in = [address](std::uint32_t net, int bits) {
    return (address ^ net) >> (32 - bits) == 0;
  };
  return in(0x7F000000, 8) || in(0x0A000000, 8) || in(0xAC100000, 12) || in(0xC0A80000, 16) ||
         in(0xA9FE0000, 16) || in(0x64400000, 10) || address == 0;
}

bool IsPrivate(const sockaddr* address) {
  if (address->sa_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, address, sizeof(v4));
    return IsPrivate4(ntohl(v4.sin_addr.s_addr));
  }
  if (address->sa_family != AF_INET6) return true;
  sockaddr_in6 v6{};
  std::memcpy(&v6, address, sizeof(v6));
  const unsigned char* bytes = v6.sin6_addr.s6_addr;
  if (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr)) {
    std::uint32_t v4 = 0;
    std::memcpy(&v4, bytes + 12, sizeof(v4));
    return IsPrivate4(ntohl(v4));
  }
  const bool local = bytes[0] == 0xFE && (bytes[1] & 0xC0) == 0x80;
  const bool unique_local = (bytes[0] & 0xFE) == 0xFC;
  return IN6_IS_ADDR_LOOPBACK(&v6.sin6_addr) || local || unique_local;
}

class Socket {
 public:
  explicit Socket(int family)
      : fd_(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  // 0, or the system's error.
  int Connect(const addrinfo& target) const {
    if (fd_ < 0) return errno;
    if (::connect(fd_, target.ai_addr, target.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    if (!Await(POLLOUT)) return ETIMEDOUT;
    int error = 0;
    socklen_t length = sizeof(error);
    ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &length);
    return error;
  }
  // Sends `bytes`; returns the first bytes of the answer, "" if the other side closes.
  std::string Ask(std::string_view bytes) const {
    std::array<char, 16> answer{};
    if (::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0 || !Await(POLLIN)) return "";
    const ssize_t read = ::recv(fd_, answer.data(), answer.size(), 0);
    return {answer.data(), static_cast<std::size_t>(std::max<ssize_t>(read, 0))};
  }

 private:
  bool Await(short events) const {
    pollfd poll{fd_, events, 0};
    return ::poll(&poll, 1, kProbeMs) > 0;
  }

  int fd_;
};

// A server of gRPC without TLS answers the beginning of HTTP/2 with a SETTINGS frame.
bool SpeaksPlainHttp2(const Socket& socket) {
  constexpr std::string_view kBeginning("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\4\0\0\0\0\0", 33);
  const std::string answer = socket.Ask(kBeginning);
  return answer.size() >= 4 && answer[3] == 4;
}

absl::Status Unavailable(const std::string& address, const std::string& reason) {
  return absl::UnavailableError(
      absl::StrCat("no server answers at ", address, " (--server): ", reason));
}

absl::Status ExplainTls(const std::string& address, bool uses_tls, bool plain) {
  if (uses_tls && plain) {
    return Unavailable(
        address,
        "it speaks no TLS; leave out --tls-ca, --tls-cert and --tls-key, or give the "
        "server --tls-cert and --tls-key");
  }
  if (uses_tls) {
    return Unavailable(address,
                       "the TLS handshake failed; --tls-ca must name the CA of the server's "
                       "certificate, which must be made out to this host, and a server that asks "
                       "for certificates needs --tls-cert and --tls-key");
  }
  if (!plain) {
    return Unavailable(address,
                       "something listens there, but does not speak HTTP/2 in plain text; if it is "
                       "a server with TLS, give --tls-ca");
  }
  return Unavailable(address, "it answers too late");
}

}  // namespace

absl::Status CheckServerAddress(const std::string& address) {
  if (IsSocketFile(address)) return absl::OkStatus();
  for (const std::string& server : ServersOf(address)) {
    HOMING_RETURN_IF_ERROR(ParseHostPort("--server", server, 1).status());
  }
  return absl::OkStatus();
}

std::string ProxyOfEnvironment() {
  for (const char* variable : kProxyVariables) {
    const char* value = std::getenv(variable);
    if (value != nullptr && *value != '\0') return absl::StrCat(variable, " (", value, ")");
  }
  return "";
}

bool MayUseProxy(const std::string& address) {
  if (IsSocketFile(address) || ProxyOfEnvironment().empty()) return false;
  const auto target = ParseHostPort("--server", ServersOf(address)[0], 1);
  if (!target.ok()) return true;
  const std::string& host = target->host;
  if (!absl::StrContains(host, ".") && !absl::StrContains(host, ":")) return false;
  if (absl::EndsWith(host, ".local") || absl::EndsWith(host, ".localhost")) return false;
  int error = 0;
  const Addresses found = Resolve(*target, &error);
  if (found == nullptr) return true;
  for (const addrinfo* next = found.get(); next != nullptr; next = next->ai_next) {
    if (!IsPrivate(next->ai_addr)) return true;
  }
  return false;
}

absl::Status ExplainUnreachable(const std::string& address, bool uses_tls) {
  if (MayUseProxy(address)) {
    return Unavailable(address,
                       absl::StrCat("the way there is through the proxy of ", ProxyOfEnvironment(),
                                    "; name the host in no_proxy to go around it"));
  }
  // Checks only the first of several servers.
  const auto target = ParseHostPort("--server", ServersOf(address)[0], 1);
  if (!target.ok()) return Unavailable(address, "nothing listens there");
  int error = 0;
  const Addresses found = Resolve(*target, &error);
  if (found == nullptr) {
    return Unavailable(address, absl::StrCat("the name ", target->host,
                                             " cannot be resolved: ", ::gai_strerror(error)));
  }
  int last = 0;
  for (const addrinfo* next = found.get(); next != nullptr; next = next->ai_next) {
    const Socket socket(next->ai_family);
    last = socket.Connect(*next);
    if (last == 0) return ExplainTls(address, uses_tls, SpeaksPlainHttp2(socket));
  }
  return Unavailable(address, std::strerror(last));
}

}  // namespace homing::client
