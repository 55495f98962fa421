// A service of the API. gRPC hands a call over as soon as its headers have arrived: of a method
// with one request it would otherwise first await the request, without a limit of time or number,
// and parse it, whoever the caller is.
#ifndef SERVER_RPC_API_SERVICE_H_
#define SERVER_RPC_API_SERVICE_H_

#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/impl/service_type.h>

#include <functional>
#include <list>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/rpc/unary_call.h"

namespace homing::server {

// Thread-safe once it is constructed: gRPC calls the methods on its own threads.
class ApiService : public grpc::Service {
 protected:
  // `core` must outlive the service.
  explicit ApiService(ServiceCore* core) : core_(core) {}

  // For gRPC every method is a two-way stream: on the wire all kinds are alike. A call of `rpc` is
  // a `Stream`.
  template <typename Stream, typename Response>
  void AddStream(Rpc rpc) {
    Add<Response>(rpc, [this](grpc::CallbackServerContext* context) {
      const auto stream = std::make_shared<Stream>(core_, context);
      stream->Open();
      return stream.get();
    });
  }
  // `handle` begins to serve a call, see ServeUnary.
  template <typename Service, typename Request, typename Response>
  void AddUnary(Rpc rpc,
                void (Service::*handle)(const UnaryCall::Ptr&, const Request*, Response*)) {
    const auto handler = [this, handle](const UnaryCall::Ptr& call,
                                        const UnaryCall::Message& request,
                                        UnaryCall::Message* response) {
      (static_cast<Service*>(this)->*handle)(call, static_cast<const Request*>(&request),
                                             static_cast<Response*>(response));
    };
    Add<grpc::ByteBuffer>(rpc, [this, rpc, handler](grpc::CallbackServerContext* context) {
      const auto call = std::make_shared<UnaryCall>(
          core_, context, rpc, std::make_unique<Request>(), std::make_unique<Response>(), handler);
      call->Open();
      return call.get();
    });
  }
  ServiceCore* core() { return core_; }

 private:
  template <typename Response>
  void Add(Rpc rpc, std::function<grpc::ServerBidiReactor<grpc::ByteBuffer, Response>*(
                        grpc::CallbackServerContext*)>
                        open) {
    const std::string& path =
        paths_.emplace_back(absl::StrCat("/", std::string(TraitsOf(rpc).method)));
    AddMethod(new grpc::internal::RpcServiceMethod(
        path.c_str(), grpc::internal::RpcMethod::BIDI_STREAMING, nullptr));
    MarkMethodRawCallback(
        static_cast<int>(paths_.size()) - 1,
        new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, Response>(std::move(open)));
  }

  ServiceCore* const core_;
  // gRPC keeps pointers to them.
  std::list<std::string> paths_;
};

}  // namespace homing::server

#endif  // SERVER_RPC_API_SERVICE_H_
