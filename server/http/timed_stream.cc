#include "server/http/timed_stream.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <openssl/err.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace homing::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// Interval at which a wait looks for other connections that wait.
constexpr milliseconds kGlance{50};

// Converts an address to the form that the library's requests show.
void Describe(const sockaddr_storage& address, socklen_t size, std::string* ip, int* port) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  if (::getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(),
                    service.data(), service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return;
  }
  *ip = host.data();
  *port = std::atoi(service.data());
}

}  // namespace

TimedStream::TimedStream(int socket, SSL_CTX* context, const Limits& limits)
    : socket_(socket), limits_(limits) {
  // OpenSSL would wait for the rest of a record without end.
  ::fcntl(socket_, F_SETFL, ::fcntl(socket_, F_GETFL) | O_NONBLOCK);
  if (context == nullptr) return;
  ssl_.reset(SSL_new(context));
  SSL_set_fd(ssl_.get(), socket_);
  SSL_set_mode(ssl_.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
}

TimedStream::~TimedStream() {
  if (ssl_) SSL_shutdown(ssl_.get());
  ERR_clear_error();
}

bool TimedStream::Await(short events, Time end) const {
  const auto left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
  pollfd file{socket_, events, 0};
  return left.count() > 0 && ::poll(&file, 1, static_cast<int>(left.count())) > 0;
}

bool TimedStream::AwaitBytes(Time end) const {
  const Time hurry = steady_clock::now() + limits_.hurry;
  while (!Await(POLLIN, std::min(end, steady_clock::now() + kGlance))) {
    const Time now = steady_clock::now();
    const bool others = limits_.waiting != nullptr && *limits_.waiting > 0;
    if (now >= end || (others && now >= hurry)) return false;
  }
  return true;
}

bool TimedStream::AwaitSsl(int result, Time end) {
  const int wanted = SSL_get_error(ssl_.get(), result);
  ERR_clear_error();
  if (wanted == SSL_ERROR_WANT_READ) return AwaitBytes(end);
  return wanted == SSL_ERROR_WANT_WRITE && Await(POLLOUT, end);
}

bool TimedStream::Begin() {
  const Time end = steady_clock::now() + limits_.request_time;
  if (!ssl_) return true;
  int result = 0;
  while ((result = SSL_accept(ssl_.get())) != 1) {
    if (!AwaitSsl(result, end)) return false;
  }
  return true;
}

bool TimedStream::AwaitRequest() {
  // The library answers a truncated request, and would then read the next one.
  if (broken_) return false;
  const bool has_bytes = first_ < last_ || (ssl_ && SSL_pending(ssl_.get()) > 0);
  if (!has_bytes && !AwaitBytes(steady_clock::now() + limits_.idle_time)) return false;
  bytes_left_ = limits_.request_bytes;
  request_end_ = steady_clock::now() + limits_.request_time;
  return true;
}

bool TimedStream::is_readable() const { return first_ < last_ || Await(POLLIN, request_end_); }

bool TimedStream::is_writable() const {
  char next = 0;
  const ssize_t seen = ::recv(socket_, &next, 1, MSG_PEEK | MSG_DONTWAIT);
  const bool closed = seen == 0 || (seen < 0 && errno != EAGAIN && errno != EWOULDBLOCK);
  return !closed && Await(POLLOUT, steady_clock::now() + limits_.request_time);
}

ssize_t TimedStream::Receive(char* bytes, std::size_t size, Time end) {
  while (true) {
    if (ssl_) {
      const int n = SSL_read(ssl_.get(), bytes, static_cast<int>(size));
      if (n > 0) return n;
      if (!AwaitSsl(n, end)) return -1;
    } else {
      const ssize_t n = ::recv(socket_, bytes, size, MSG_DONTWAIT);
      if (n >= 0) return n;
      if (errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) return -1;
      if (!AwaitBytes(end)) return -1;
    }
    // A client that sends one byte now and then must not hold a thread.
    if (steady_clock::now() >= end) return -1;
  }
}

ssize_t TimedStream::read(char* bytes, std::size_t size) {
  if (first_ == last_) {
    const bool in_time = bytes_left_ > 0 && steady_clock::now() < request_end_;
    const ssize_t n =
        in_time ? Receive(buffer_.data(), std::min(buffer_.size(), bytes_left_), request_end_) : -1;
    broken_ = n <= 0;
    if (broken_) return n;
    first_ = 0;
    last_ = static_cast<std::size_t>(n);
    bytes_left_ -= last_;
  }
  const std::size_t given = std::min(size, last_ - first_);
  std::memcpy(bytes, buffer_.data() + first_, given);
  first_ += given;
  consumed_ += given;
  return static_cast<ssize_t>(given);
}

ssize_t TimedStream::SendSome(const char* bytes, std::size_t size, Time end) {
  while (true) {
    if (ssl_) {
      const int n =
          SSL_write(ssl_.get(), bytes, static_cast<int>(std::min(size, std::size_t{1} << 14)));
      if (n > 0) return n;
      if (!AwaitSsl(n, end)) return -1;
    } else {
      const ssize_t n = ::send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n >= 0) return n;
      if (errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) return -1;
      if (!Await(POLLOUT, end)) return -1;
    }
  }
}

ssize_t TimedStream::write(const char* bytes, std::size_t size) {
  const Time end = steady_clock::now() + limits_.request_time;
  std::size_t sent = 0;
  while (sent < size) {
    const ssize_t n = SendSome(bytes + sent, size - sent, end);
    if (n < 0 || (sent + static_cast<std::size_t>(n) < size && steady_clock::now() >= end)) {
      return -1;
    }
    sent += static_cast<std::size_t>(n);
  }
  return static_cast<ssize_t>(size);
}

void TimedStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (::getpeername(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0) {
    Describe(address, size, &ip, &port);
  }
}

void TimedStream::get_local_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0) {
    Describe(address, size, &ip, &port);
  }
}

}  // namespace homing::server
