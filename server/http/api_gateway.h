// The API for browsers: calls the server's own gRPC methods, with JSON made from the same messages.
// Rights, limits and metrics are therefore those of gRPC.
#ifndef SERVER_HTTP_API_GATEWAY_H_
#define SERVER_HTTP_API_GATEWAY_H_

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>
#include <grpcpp/support/byte_buffer.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "homing/base/mutex.h"

namespace grpc {
class ClientContext;
class Status;
}  // namespace grpc

namespace homing::server {

struct ApiAnswer {
  // The HTTP status code.
  int status = 200;
  std::string json;
};

// The credentials and the trace of a browser's request.
struct ApiCaller {
  std::string token;
  // The header "traceparent"; empty: none.
  std::string trace;

  void AddTo(grpc::ClientContext* context) const;
};

// {"code": "NOT_FOUND", "message": "..."} with the fitting status.
ApiAnswer ToAnswer(const grpc::Status& status);
ApiAnswer ToAnswer(const absl::Status& status);
// Enumerations as names, int64 as strings, fields in lowerCamelCase; unset fields are left out.
std::string ToJson(const google::protobuf::Message& message);

// Thread-safe.
class ApiGateway {
 public:
  explicit ApiGateway(std::shared_ptr<grpc::Channel> channel) : channel_(std::move(channel)) {}

  // `method` is "JourneyService/GetJourney"; streams are refused.
  ApiAnswer Call(const std::string& method, const std::string& json, const ApiCaller& caller) const;

  // The JSON of a serialized message, which `message` is parsed from. That of the last one of each
  // type is kept: all open consoles are sent the same message at nearly the same time.
  std::string ToSharedJson(const grpc::ByteBuffer& bytes, google::protobuf::Message* message) const;

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }

 private:
  const std::shared_ptr<grpc::Channel> channel_;
  mutable Mutex mutex_;
  // By type: the bytes of the last message, and its JSON.
  mutable std::map<const google::protobuf::Descriptor*, std::pair<std::string, std::string>> last_
      HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_HTTP_API_GATEWAY_H_
