// A TCP connection on loopback without any protocol.
#ifndef TESTS_FAULTS_RAW_SOCKET_H_
#define TESTS_FAULTS_RAW_SOCKET_H_

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>

namespace homing::faults {

class RawSocket {
 public:
  // `from`: the client's own address, such as 127.0.0.3.
  explicit RawSocket(int port, const char* from = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_in own = AddressOf(from, 0);
    const sockaddr_in to = AddressOf("127.0.0.1", port);
    connected_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) == 0 &&
                 ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0;
  }
  RawSocket(RawSocket&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), connected_(other.connected_) {}
  ~RawSocket() { ::close(socket_); }

  bool connected() const { return connected_; }
  // All bytes; gives up when nothing can be sent for two seconds.
  bool Send(const std::string& bytes) const {
    const timeval most{2, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &most, sizeof(most));
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }

  // A port that is free now.
  static int FreePort() {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = AddressOf("127.0.0.1", 0);
    socklen_t size = sizeof(address);
    ::bind(socket, reinterpret_cast<const sockaddr*>(&address), size);
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(socket);
    return ntohs(address.sin_port);
  }

 private:
  static sockaddr_in AddressOf(const char* ip, int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, ip, &address.sin_addr);
    return address;
  }

  int socket_;
  bool connected_ = false;
};

}  // namespace homing::faults

#endif  // TESTS_FAULTS_RAW_SOCKET_H_
