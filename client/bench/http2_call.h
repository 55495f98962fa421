// One bidirectional gRPC call on its own connection. A load has a thousand of these: gRPC's client
// would take the processor time that the server needs. Source: RFC 9113 by nghttp2;
// gRPC over HTTP/2.
#ifndef CLIENT_BENCH_HTTP2_CALL_H_
#define CLIENT_BENCH_HTTP2_CALL_H_

#include <nghttp2/nghttp2.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/bench/http2_endpoint.h"

namespace homing::client {

// Not thread-safe. Only Open blocks.
class Http2Call {
 public:
  using OnMessage = std::function<void(std::string_view message)>;

  // `method` is "/package.Service/Method". Connects, with TLS if set. UNAVAILABLE.
  static absl::StatusOr<std::unique_ptr<Http2Call>> Open(const Http2Endpoint& endpoint,
                                                         const std::string& method,
                                                         OnMessage on_message);
  ~Http2Call();
  Http2Call(const Http2Call&) = delete;
  Http2Call& operator=(const Http2Call&) = delete;

  int socket() const { return socket_; }
  // Queues one message in two parts; the next Flush sends it.
  void Queue(std::string_view begin, std::string_view end = {});
  // Closes the sending side, after the queued messages.
  void HalfClose();
  // Queued messages have left this program.
  bool sent_all() const { return taken_ == queued_.size() && written_ == output_.size(); }
  // Sends as much as the peer and the socket accept.
  void Flush();
  // Reads the received data and queues HTTP/2's replies. `to_the_end`: the peer has closed the
  // connection, so no further event will come.
  void Receive(bool to_the_end);
  bool done() const { return done_; }
  // REQUIRES: done.
  const absl::Status& status() const { return status_; }
  void Cancel();

 private:
  explicit Http2Call(OnMessage on_message) : on_message_(std::move(on_message)) {}
  absl::Status Begin(const Http2Endpoint& endpoint, const std::string& method);
  void Took(std::string_view data);
  void Finish(const absl::Status& status);
  // Bytes read; 0: none now; negative: the connection is broken.
  std::ptrdiff_t Read(char* data, std::size_t size);
  std::ptrdiff_t Write(const char* data, std::size_t size);

  struct Callbacks;

  const OnMessage on_message_;
  int socket_ = -1;
  std::shared_ptr<SSL> tls_;
  nghttp2_session* session_ = nullptr;
  int stream_ = 0;
  // Bytes from taken_ on are not given to HTTP/2 yet; bytes from written_ on not to the socket.
  std::string queued_;
  std::size_t taken_ = 0;
  std::string output_;
  std::size_t written_ = 0;
  std::string received_;
  bool half_closed_ = false;
  // From the trailers.
  int code_ = -1;
  std::string message_;
  bool done_ = false;
  absl::Status status_;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_HTTP2_CALL_H_
