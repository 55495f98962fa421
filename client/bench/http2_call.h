// One two-way gRPC call on a connection of its own, without gRPC. A load takes a thousand of these:
// what gRPC's client would take of the processor is left to the server. Source: RFC 9113 by
// nghttp2; gRPC over HTTP/2.
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

// For one thread. Nothing waits but Open.
class Http2Call {
 public:
  using OnMessage = std::function<void(std::string_view message)>;

  // `method` as "/package.Service/Method". Connects, with TLS where it is asked for. UNAVAILABLE.
  static absl::StatusOr<std::unique_ptr<Http2Call>> Open(const Http2Endpoint& endpoint,
                                                         const std::string& method,
                                                         OnMessage on_message);
  ~Http2Call();
  Http2Call(const Http2Call&) = delete;
  Http2Call& operator=(const Http2Call&) = delete;

  int socket() const { return socket_; }
  // One message, in two pieces; goes out with the next Flush.
  void Queue(std::string_view begin, std::string_view end = {});
  // After what is queued.
  void HalfClose();
  // Messages queued have left, as far as this program knows.
  bool sent_all() const { return taken_ == queued_.size() && written_ == output_.size(); }
  // Sends as much as the peer and the socket take.
  void Flush();
  // Takes what has come and answers what HTTP/2 asks for. `to_the_end`: the peer has hung up, and
  // nothing will tell of it again.
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
  // Bytes; 0: none for now; below 0: the connection is gone.
  std::ptrdiff_t Read(char* data, std::size_t size);
  std::ptrdiff_t Write(const char* data, std::size_t size);

  struct Callbacks;

  const OnMessage on_message_;
  int socket_ = -1;
  std::shared_ptr<SSL> tls_;
  nghttp2_session* session_ = nullptr;
  int stream_ = 0;
  // Not yet given to HTTP/2 from taken_ on; not yet to the socket from written_ on.
  std::string queued_;
  std::size_t taken_ = 0;
  std::string output_;
  std::size_t written_ = 0;
  std::string received_;
  bool half_closed_ = false;
  // As the trailers say.
  int code_ = -1;
  std::string message_;
  bool done_ = false;
  absl::Status status_;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_HTTP2_CALL_H_
