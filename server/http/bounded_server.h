// The library's HTTP server with limits for each client.
#ifndef SERVER_HTTP_BOUNDED_SERVER_H_
#define SERVER_HTTP_BOUNDED_SERVER_H_

#include <httplib.h>
#include <openssl/ssl.h>

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "homing/base/mutex.h"

namespace homing::server {

// The library calls the handlers on up to kThreads threads at a time. UseCertificate is
// thread-safe.
class BoundedServer final : public httplib::Server {
 public:
  // A thread a connection: browsers keep some open, and each event stream holds one.
  static constexpr std::size_t kThreads = 64;
  // Most connections of one address, so that other addresses still find a thread.
  static constexpr std::size_t kMostOfOneAddress = 48;
  static constexpr std::size_t kMaxBody = 1 << 20;

  BoundedServer();

  // Serves TLS with these PEM files from the next connection on. INVALID_ARGUMENT: they cannot be
  // used; the previous ones stay in use.
  absl::Status UseCertificate(const std::string& certificate, const std::string& key);
  // Accepts no more connections and closes the others, also those whose requests are incomplete.
  // Handlers that run continue. Once, after the server listens.
  void StopServing();

 private:
  // Called by the library on one of its threads.
  bool process_and_close_socket(socket_t socket) override;
  bool Serve(socket_t socket);
  // False: the address has kMostOfOneAddress connections already, or the server stops.
  bool Enter(const std::string& address, socket_t socket);
  void Leave(const std::string& address, socket_t socket);

  Mutex mutex_;
  // Null without TLS. A connection keeps the context that it started with.
  std::shared_ptr<SSL_CTX> context_ HOMING_GUARDED_BY(mutex_);
  std::map<std::string, std::size_t> connections_ HOMING_GUARDED_BY(mutex_);
  std::set<socket_t> sockets_ HOMING_GUARDED_BY(mutex_);
  // Connections that no thread serves yet.
  std::atomic<int> waiting_ = 0;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_HTTP_BOUNDED_SERVER_H_
