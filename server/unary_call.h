// One unary RPC on the pool: I/O threads never compute. Source: own design.
#ifndef SERVER_UNARY_CALL_H_
#define SERVER_UNARY_CALL_H_

#include <grpcpp/support/server_callback.h>

#include <utility>

#include "server/service_core.h"
#include "server/status_conversion.h"

namespace homing::server {

// `call` is absl::Status(); it may use the request and the response of the RPC, which outlive it.
template <typename Call>
grpc::ServerUnaryReactor* ServeUnary(ServiceCore* core, grpc::CallbackServerContext* context,
                                     Call call) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  if (core->streams.draining()) {
    reactor->Finish(ToGrpcStatus(DrainingError()));
  } else if (!core->pool.TryRun([reactor, call = std::move(call)] {
               reactor->Finish(ToGrpcStatus(Guarded(call)));
             })) {
    reactor->Finish(ToGrpcStatus(BusyError()));
  }
  return reactor;
}

}  // namespace homing::server

#endif  // SERVER_UNARY_CALL_H_
