// The API for browsers: calls the server's own gRPC methods, with JSON made from the same messages.
// Rights, limits and metrics are therefore those of gRPC.
#ifndef SERVER_HTTP_API_GATEWAY_H_
#define SERVER_HTTP_API_GATEWAY_H_

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>

#include <memory>
#include <string>

#include "absl/status/status.h"

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

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }

 private:
  const std::shared_ptr<grpc::Channel> channel_;
};

}  // namespace homing::server

#endif  // SERVER_HTTP_API_GATEWAY_H_
