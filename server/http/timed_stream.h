// One HTTP connection whose requests have a limited size and time: the library limits each line and
// each wait, but neither their number nor their sum.
#ifndef SERVER_HTTP_TIMED_STREAM_H_
#define SERVER_HTTP_TIMED_STREAM_H_

#include <httplib.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "server/access/openssl_handle.h"

namespace homing::server {

// Not thread-safe.
class TimedStream final : public httplib::Stream {
 public:
  struct Limits {
    // Size of one request with its headers.
    std::size_t request_bytes = 0;
    // Time for a request from its first byte to its last, for the TLS handshake, and for each piece
    // that is sent.
    std::chrono::milliseconds request_time{};
    // Time between two requests.
    std::chrono::milliseconds idle_time{};
    // Most time to wait for the client's next bytes while `*waiting` other connections, if any,
    // wait for a thread.
    std::chrono::milliseconds hurry{};
    const std::atomic<int>* waiting = nullptr;
  };

  // `context` is null without TLS. Does not close `socket`.
  TimedStream(int socket, SSL_CTX* context, const Limits& limits);
  ~TimedStream() override;
  TimedStream(const TimedStream&) = delete;
  TimedStream& operator=(const TimedStream&) = delete;

  // The TLS handshake. False: it failed, or took too long.
  bool Begin();
  // Waits for the next request. False: none came.
  bool AwaitRequest();

  // Bytes read so far.
  std::uint64_t consumed() const { return consumed_; }

  bool is_readable() const override;
  // The other side has not closed the connection.
  bool is_writable() const override;
  // Up to `size` bytes; 0 at the end, -1 beyond a limit.
  ssize_t read(char* bytes, std::size_t size) override;
  // All of them, or -1.
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Time = std::chrono::steady_clock::time_point;

  bool Await(short events, Time end) const;
  // As Await, for bytes of the client, whom others that wait may cut short.
  bool AwaitBytes(Time end) const;
  // Waits for the socket as the last SSL call, with this `result`, requires. False: the connection
  // has ended, or `end` has passed.
  bool AwaitSsl(int result, Time end);
  ssize_t Receive(char* bytes, std::size_t size, Time end);
  ssize_t SendSome(const char* bytes, std::size_t size, Time end);

  const int socket_;
  const Limits limits_;
  // Null without TLS.
  OpensslPtr<SSL> ssl_;
  // Received bytes that were not read yet: the library reads byte by byte.
  std::array<char, 4096> buffer_{};
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  std::uint64_t consumed_ = 0;
  // The last request was incomplete.
  bool broken_ = false;
  // Bytes that the current request may still have.
  std::size_t bytes_left_ = 0;
  Time request_end_;
};

}  // namespace homing::server

#endif  // SERVER_HTTP_TIMED_STREAM_H_
