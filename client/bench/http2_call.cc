#include "client/bench/http2_call.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <openssl/err.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::size_t kPrefix = 5;  // of a message: compressed or not, then its size
constexpr std::size_t kReadBytes = 16384;

nghttp2_nv Header(std::string_view name, std::string_view value) {
  const auto bytes = [](std::string_view text) {
    // nghttp2 only reads them.
    return reinterpret_cast<std::uint8_t*>(const_cast<char*>(text.data()));
  };
  return {bytes(name), bytes(value), name.size(), value.size(), NGHTTP2_NV_FLAG_NONE};
}

std::string_view View(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

bool IsForNow(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

std::ptrdiff_t TlsResult(SSL* tls, int result) {
  if (result > 0) return result;
  const int error = SSL_get_error(tls, result);
  ERR_clear_error();
  return error == SSL_ERROR_WANT_READ || error == SSL_ERROR_WANT_WRITE ? 0 : -1;
}

}  // namespace

// Callbacks of nghttp2; their user data is the call.
struct Http2Call::Callbacks {
  static Http2Call& Of(void* call) { return *static_cast<Http2Call*>(call); }

  static ssize_t TakeQueued(nghttp2_session* /*session*/, std::int32_t /*stream*/,
                            std::uint8_t* data, std::size_t size, std::uint32_t* flags,
                            nghttp2_data_source* /*source*/, void* user) {
    Http2Call& call = Of(user);
    const std::size_t count = std::min(size, call.queued_.size() - call.taken_);
    std::copy_n(call.queued_.data() + call.taken_, count, data);
    call.taken_ += count;
    if (call.taken_ == call.queued_.size()) {
      call.queued_.clear();
      call.taken_ = 0;
      if (call.half_closed_) *flags |= NGHTTP2_DATA_FLAG_EOF;
    }
    if (count == 0 && !call.half_closed_) return NGHTTP2_ERR_DEFERRED;
    return static_cast<ssize_t>(count);
  }
  static int Data(nghttp2_session* /*session*/, std::uint8_t /*flags*/, std::int32_t /*stream*/,
                  const std::uint8_t* data, std::size_t size, void* user) {
    Of(user).Took(View(data, size));
    return 0;
  }
  static int HeaderField(nghttp2_session* /*session*/, const nghttp2_frame* /*frame*/,
                         const std::uint8_t* name, std::size_t name_size, const std::uint8_t* value,
                         std::size_t value_size, std::uint8_t /*flags*/, void* user) {
    Http2Call& call = Of(user);
    const std::string_view field = View(name, name_size);
    const std::string text(View(value, value_size));
    if (field == "grpc-status" && !absl::SimpleAtoi(text, &call.code_)) call.code_ = -1;
    if (field == "grpc-message") call.message_ = text;
    if (field == ":status" && text != "200") call.message_ = absl::StrCat("HTTP status ", text);
    return 0;
  }
  static int Closed(nghttp2_session* /*session*/, std::int32_t /*stream*/, std::uint32_t error,
                    void* user) {
    Http2Call& call = Of(user);
    if (call.code_ >= 0) {
      call.Finish(absl::Status(static_cast<absl::StatusCode>(call.code_), call.message_));
    } else {
      call.Finish(absl::UnavailableError(absl::StrCat(
          "the stream was ended: ", nghttp2_http2_strerror(error), " ", call.message_)));
    }
    return 0;
  }

  static nghttp2_session_callbacks* Make() {
    nghttp2_session_callbacks* all = nullptr;
    nghttp2_session_callbacks_new(&all);
    nghttp2_session_callbacks_set_on_data_chunk_recv_callback(all, Data);
    nghttp2_session_callbacks_set_on_header_callback(all, HeaderField);
    nghttp2_session_callbacks_set_on_stream_close_callback(all, Closed);
    return all;
  }
};

absl::StatusOr<std::unique_ptr<Http2Call>> Http2Call::Open(const Http2Endpoint& endpoint,
                                                           const std::string& method,
                                                           OnMessage on_message) {
  std::unique_ptr<Http2Call> call(new Http2Call(std::move(on_message)));
  HOMING_ASSIGN_OR_RETURN(call->socket_, endpoint.Dial());
  HOMING_ASSIGN_OR_RETURN(call->tls_, endpoint.Secure(call->socket_));
  fcntl(call->socket_, F_SETFL, fcntl(call->socket_, F_GETFL) | O_NONBLOCK);
  HOMING_RETURN_IF_ERROR(call->Begin(endpoint, method));
  return call;
}

Http2Call::~Http2Call() {
  nghttp2_session_del(session_);
  tls_.reset();
  if (socket_ >= 0) close(socket_);
}

absl::Status Http2Call::Begin(const Http2Endpoint& endpoint, const std::string& method) {
  nghttp2_session_callbacks* const callbacks = Callbacks::Make();
  const int made = nghttp2_session_client_new(&session_, callbacks, this);
  nghttp2_session_callbacks_del(callbacks);
  if (made != 0) return absl::InternalError(nghttp2_strerror(made));
  nghttp2_submit_settings(session_, NGHTTP2_FLAG_NONE, nullptr, 0);
  const std::string authorization = absl::StrCat("Bearer ", endpoint.token());
  std::vector<nghttp2_nv> headers = {
      Header(":method", "POST"), Header(":scheme", tls_ == nullptr ? "http" : "https"),
      Header(":path", method),   Header(":authority", endpoint.authority()),
      Header("te", "trailers"),  Header("content-type", "application/grpc"),
  };
  if (!endpoint.token().empty()) headers.push_back(Header("authorization", authorization));
  nghttp2_data_provider body{};
  body.read_callback = Callbacks::TakeQueued;
  stream_ =
      nghttp2_submit_request(session_, nullptr, headers.data(), headers.size(), &body, nullptr);
  return stream_ > 0 ? absl::OkStatus() : absl::InternalError(nghttp2_strerror(stream_));
}

void Http2Call::Queue(std::string_view begin, std::string_view end) {
  const std::uint32_t size = htonl(static_cast<std::uint32_t>(begin.size() + end.size()));
  queued_.push_back(0);
  queued_.append(reinterpret_cast<const char*>(&size), sizeof size);
  queued_.append(begin);
  queued_.append(end);
  nghttp2_session_resume_data(session_, stream_);
}

void Http2Call::HalfClose() {
  half_closed_ = true;
  nghttp2_session_resume_data(session_, stream_);
}

void Http2Call::Flush() {
  while (!done_) {
    if (written_ == output_.size()) {
      output_.clear();
      written_ = 0;
      const std::uint8_t* data = nullptr;
      while (output_.size() < kReadBytes) {
        const ssize_t size = nghttp2_session_mem_send(session_, &data);
        if (size < 0) return Finish(absl::InternalError(nghttp2_strerror(static_cast<int>(size))));
        if (size == 0) break;
        output_.append(View(data, static_cast<std::size_t>(size)));
      }
      if (output_.empty()) return;
    }
    const std::ptrdiff_t sent = Write(output_.data() + written_, output_.size() - written_);
    if (sent < 0) return Finish(absl::UnavailableError("the connection was lost"));
    if (sent == 0) return;
    written_ += static_cast<std::size_t>(sent);
  }
}

void Http2Call::Receive(bool to_the_end) {
  std::array<char, kReadBytes> data;
  while (!done_) {
    const std::ptrdiff_t size = Read(data.data(), data.size());
    if (size < 0) return Finish(absl::UnavailableError("the connection was lost"));
    if (size == 0) break;
    const ssize_t taken =
        nghttp2_session_mem_recv(session_, reinterpret_cast<const std::uint8_t*>(data.data()),
                                 static_cast<std::size_t>(size));
    if (taken < 0) return Finish(absl::InternalError(nghttp2_strerror(static_cast<int>(taken))));
    // A socket that returned less than requested is empty, and reports when it has data again.
    const bool is_empty = tls_ == nullptr && static_cast<std::size_t>(size) < data.size();
    if (is_empty && !to_the_end) break;
  }
  Flush();
}

void Http2Call::Took(std::string_view data) {
  received_.append(data);
  std::string_view rest = received_;
  while (rest.size() >= kPrefix) {
    std::uint32_t size = 0;
    std::memcpy(&size, rest.data() + 1, sizeof size);
    size = ntohl(size);
    if (rest.size() - kPrefix < size) break;
    on_message_(rest.substr(kPrefix, size));
    rest.remove_prefix(kPrefix + size);
  }
  received_.erase(0, received_.size() - rest.size());
}

void Http2Call::Finish(const absl::Status& status) {
  if (std::exchange(done_, true)) return;
  status_ = status;
}

void Http2Call::Cancel() { Finish(absl::CancelledError("given up")); }

std::ptrdiff_t Http2Call::Read(char* data, std::size_t size) {
  if (tls_ != nullptr)
    return TlsResult(tls_.get(), SSL_read(tls_.get(), data, static_cast<int>(size)));
  const ssize_t got = recv(socket_, data, size, 0);
  if (got > 0) return got;
  return got < 0 && IsForNow(errno) ? 0 : -1;
}

std::ptrdiff_t Http2Call::Write(const char* data, std::size_t size) {
  if (tls_ != nullptr)
    return TlsResult(tls_.get(), SSL_write(tls_.get(), data, static_cast<int>(size)));
  const ssize_t sent = send(socket_, data, size, MSG_NOSIGNAL);
  if (sent >= 0) return sent;
  return IsForNow(errno) ? 0 : -1;
}

}  // namespace homing::client
