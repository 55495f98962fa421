#include "tests/support/tcp_proxy.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "homing/base/mutex.h"

namespace homing {
namespace {

constexpr int kPollMs = 20;

sockaddr_in Loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

void SendAtOnce(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
}

// The other end sees a reset.
void Reset(int socket) {
  const linger hard{1, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &hard, sizeof(hard));
  ::close(socket);
}

bool SendAll(int socket, const char* bytes, ssize_t size) {
  while (size > 0) {
    const ssize_t sent = ::send(socket, bytes, static_cast<std::size_t>(size), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes += sent;
    size -= sent;
  }
  return true;
}

}  // namespace

struct TcpProxy::Link {
  int client = -1;
  int server = -1;
  // Bytes until it is cut; below 0: never.
  std::int64_t left = -1;
  std::atomic<bool> cut = false;
  std::atomic<bool> frozen = false;
  std::atomic<bool> over = false;
  std::thread carrier;
};

TcpProxy::TcpProxy(const std::string& upstream) {
  SetUpstream(upstream);
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = Loopback(0);
  ::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  ::listen(listener_, 1024);
  socklen_t size = sizeof(address);
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  acceptor_ = std::thread([this] { Accept(); });
}

TcpProxy::~TcpProxy() {
  stopping_ = true;
  acceptor_.join();
  for (const auto& link : links_) link->carrier.join();
  ::close(listener_);
}

void TcpProxy::SetUpstream(const std::string& upstream) {
  const int port = std::stoi(upstream.substr(upstream.rfind(':') + 1));
  upstream_port_ = static_cast<std::uint16_t>(port);
}

void TcpProxy::CutAll() {
  const MutexLock lock(mutex_);
  for (const auto& link : links_) link->cut = true;
}

void TcpProxy::FreezeAll() {
  const MutexLock lock(mutex_);
  for (const auto& link : links_) link->frozen = true;
}

void TcpProxy::Accept() {
  while (!stopping_) {
    pollfd ready{listener_, POLLIN, 0};
    if (::poll(&ready, 1, kPollMs) <= 0) continue;
    const auto link = std::make_shared<Link>();
    link->client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (link->client < 0) continue;
    link->server = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const sockaddr_in address = Loopback(upstream_port_);
    if (::connect(link->server, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) !=
        0) {
      Reset(link->client);
      ::close(link->server);
      continue;
    }
    SendAtOnce(link->client);
    SendAtOnce(link->server);
    link->left = cut_after_;
    ++connections_;
    const MutexLock lock(mutex_);
    // A thread that has ended and is not joined keeps its stack.
    std::erase_if(links_, [](const auto& old) {
      if (!old->over) return false;
      old->carrier.join();
      return true;
    });
    links_.push_back(link);
    link->carrier = std::thread([this, link] { Carry(link); });
  }
}

void TcpProxy::Carry(const std::shared_ptr<Link>& link) {
  while (!stopping_ && !link->cut) {
    if (link->frozen) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kPollMs));
      continue;
    }
    std::array<pollfd, 2> ends{pollfd{link->client, POLLIN, 0}, pollfd{link->server, POLLIN, 0}};
    // It may have been frozen meanwhile.
    if (::poll(ends.data(), ends.size(), kPollMs) <= 0 || link->frozen) continue;
    if (ends[0].revents != 0 && !Pass(link.get(), link->client, link->server)) break;
    if (ends[1].revents != 0 && !Pass(link.get(), link->server, link->client)) break;
  }
  Reset(link->client);
  Reset(link->server);
  link->over = true;
}

bool TcpProxy::Pass(Link* link, int from, int to) {
  std::array<char, 4096> bytes{};
  std::int64_t most = static_cast<std::int64_t>(bytes.size());
  if (link->left >= 0) most = std::min(most, link->left);
  if (most == 0) return false;
  const std::int64_t rate = rate_;
  if (rate > 0) {
    most = std::clamp<std::int64_t>(rate / 50, 1, most);
    std::this_thread::sleep_for(std::chrono::microseconds(1'000'000 * most / rate));
  }
  const ssize_t size = ::recv(from, bytes.data(), static_cast<std::size_t>(most), 0);
  if (size <= 0 || !SendAll(to, bytes.data(), size)) return false;
  bytes_ += size;
  if (link->left >= 0) link->left -= size;
  return true;
}

}  // namespace homing
