// A link that breaks: a TCP proxy on loopback whose connections are cut, frozen or slowed down.
#ifndef TESTS_SUPPORT_TCP_PROXY_H_
#define TESTS_SUPPORT_TCP_PROXY_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "homing/base/mutex.h"

namespace homing {

// Thread-safe.
class TcpProxy {
 public:
  // `upstream` is "127.0.0.1:port" and need not listen yet.
  explicit TcpProxy(const std::string& upstream);
  ~TcpProxy();
  TcpProxy(const TcpProxy&) = delete;
  TcpProxy& operator=(const TcpProxy&) = delete;

  // "127.0.0.1:port", where clients come.
  const std::string& address() const { return address_; }
  // Where connections made from now on lead to.
  void SetUpstream(const std::string& upstream);
  // Connections made from now on are reset once so many bytes have passed, both ways together.
  // Below 0: never.
  void CutAfter(std::int64_t bytes) { cut_after_ = bytes; }
  // Resets all connections that there are.
  void CutAll();
  // All connections that there are stay open, and nothing passes any more: as when a robot has
  // driven out of reach. Those made later work.
  void FreezeAll();
  // Of each connection and direction; 0: as fast as it goes.
  void SetBytesPerSecond(std::int64_t rate) { rate_ = rate; }
  // Connections made so far, and bytes passed.
  int connections() const { return connections_; }
  std::int64_t bytes() const { return bytes_; }

 private:
  struct Link;
  void Accept();
  void Carry(const std::shared_ptr<Link>& link);
  // Forwards received data; false: the link has ended.
  bool Pass(Link* link, int from, int to);

  std::atomic<std::uint16_t> upstream_port_ = 0;
  int listener_ = -1;
  std::string address_;
  std::atomic<std::int64_t> cut_after_ = -1;
  std::atomic<std::int64_t> rate_ = 0;
  std::atomic<std::int64_t> bytes_ = 0;
  std::atomic<int> connections_ = 0;
  std::atomic<bool> stopping_ = false;
  Mutex mutex_;
  std::vector<std::shared_ptr<Link>> links_;
  std::thread acceptor_;
};

}  // namespace homing

#endif  // TESTS_SUPPORT_TCP_PROXY_H_
