#include "server/http/bounded_server.h"

#include <openssl/err.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include "absl/strings/numbers.h"
#include "server/http/timed_stream.h"

namespace homing::server {
namespace {

constexpr std::chrono::seconds kIdleTime{2};
constexpr std::chrono::seconds kRequestTime{5};
// Time of a silent client while others wait for a thread.
constexpr std::chrono::milliseconds kHurry{100};
constexpr std::size_t kMaxHeaders = 64 << 10;
// Most requests of one connection.
constexpr std::size_t kMaxRequests = 1000;

// The body's size as the request declares it. Where the declaration is not one plain number, a
// proxy may see another end of the body, so the largest size closes the connection.
std::uint64_t BodyBytes(const httplib::Request& request) {
  const std::size_t lengths = request.get_header_value_count("Content-Length");
  if (request.has_header("Transfer-Encoding") || lengths > 1) {
    return std::numeric_limits<std::uint32_t>::max();
  }
  std::uint32_t bytes = 0;
  const std::string length = request.get_header_value("Content-Length");
  const bool plain = length.find_first_not_of("0123456789") == std::string::npos;
  if (lengths == 1 && (!plain || !absl::SimpleAtoi(length, &bytes))) {
    return std::numeric_limits<std::uint32_t>::max();
  }
  return bytes;
}

// Counts the connections that no thread serves yet.
class CountingPool final : public httplib::ThreadPool {
 public:
  CountingPool(std::size_t threads, std::atomic<int>* waiting)
      : ThreadPool(threads), waiting_(waiting) {}
  void enqueue(std::function<void()> serve) override {
    ++*waiting_;
    ThreadPool::enqueue([waiting = waiting_, serve = std::move(serve)] {
      --*waiting;
      serve();
    });
  }

 private:
  std::atomic<int>* const waiting_;
};

}  // namespace

BoundedServer::BoundedServer() {
  new_task_queue = [this] { return new CountingPool(kThreads, &waiting_); };
  set_tcp_nodelay(true);
  // The library's own options let a second server share the port silently.
  set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  set_payload_max_length(kMaxBody);
  // The library announces these limits in its answers.
  set_keep_alive_timeout(kIdleTime.count());
  set_keep_alive_max_count(kMaxRequests);
}

absl::Status BoundedServer::UseCertificate(const std::string& certificate, const std::string& key) {
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_server_method()), OpensslFree());
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_options(context.get(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  if (SSL_CTX_use_certificate_chain_file(context.get(), certificate.c_str()) != 1 ||
      SSL_CTX_use_PrivateKey_file(context.get(), key.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_check_private_key(context.get()) != 1) {
    ERR_clear_error();
    return absl::InvalidArgumentError("http: the TLS files cannot be used");
  }
  const MutexLock lock(mutex_);
  context_ = std::move(context);
  return absl::OkStatus();
}

void BoundedServer::StopServing() {
  stop();
  const MutexLock lock(mutex_);
  stopping_ = true;
  for (const socket_t socket : sockets_) ::shutdown(socket, SHUT_RDWR);
}

bool BoundedServer::Enter(const std::string& address, socket_t socket) {
  const MutexLock lock(mutex_);
  if (stopping_) return false;
  std::size_t& open = connections_[address];
  if (open >= kMostOfOneAddress) return false;
  ++open;
  sockets_.insert(socket);
  return true;
}

void BoundedServer::Leave(const std::string& address, socket_t socket) {
  const MutexLock lock(mutex_);
  sockets_.erase(socket);
  if (--connections_[address] == 0) connections_.erase(address);
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  std::string address;
  int port = 0;
  TimedStream(socket, nullptr, {}).get_remote_ip_and_port(address, port);
  bool served = false;
  if (Enter(address, socket)) {
    served = Serve(socket);
    Leave(address, socket);
  }
  ::shutdown(socket, SHUT_RDWR);
  ::close(socket);
  return served;
}

bool BoundedServer::Serve(socket_t socket) {
  std::shared_ptr<SSL_CTX> context;
  {
    const MutexLock lock(mutex_);
    context = context_;
  }
  TimedStream stream(socket, context.get(),
                     {kMaxHeaders + kMaxBody, kRequestTime, kIdleTime, kHurry, &waiting_});
  if (!stream.Begin()) return false;
  bool served = true;
  bool closed = false;
  for (std::size_t left = kMaxRequests; left > 0 && served && !closed; --left) {
    if (svr_sock_ == INVALID_SOCKET || !stream.AwaitRequest()) break;
    // Stays so if the request cannot be parsed: the connection is then closed.
    std::uint64_t body_end = std::numeric_limits<std::uint64_t>::max();
    served = process_request(stream, left == 1, closed, [&](httplib::Request& request) {
      // The library would decompress the body without a limit, match forms with slow patterns, and
      // send the bytes behind an answer's end where a range includes them.
      request.headers.erase("Content-Encoding");
      request.headers.erase("Content-Type");
      request.ranges.clear();
      body_end = stream.consumed() + BodyBytes(request);
    });
    // The body of a refused request must not be parsed as the next request.
    if (stream.consumed() < body_end) break;
  }
  return served;
}

}  // namespace homing::server
