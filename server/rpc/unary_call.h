// Runs one unary RPC in the worker pool, so that I/O threads never compute.
#ifndef SERVER_RPC_UNARY_CALL_H_
#define SERVER_RPC_UNARY_CALL_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "homing/base/cancellation.h"
#include "homing/base/status_macros.h"
#include "server/base/trace_scope.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/unary_reactor.h"

namespace homing::server {

// Whether the client still waits for its answer. The call must not have finished.
class UnaryCancellation : public Cancellation {
 public:
  explicit UnaryCancellation(const grpc::CallbackServerContext* context) : context_(context) {}
  bool IsCancelled() const override { return context_->IsCancelled(); }

 private:
  const grpc::CallbackServerContext* const context_;
};

// `call` is absl::Status(const JourneyFilter&), or takes the IncomingCall too. It runs only if the
// caller may do this to `resource`, and may use the RPC's request and `response`, which outlive it.
// For a pattern it must apply the filter. `pool` belongs to the core.
template <typename Call>
grpc::ServerUnaryReactor* ServeUnary(ServiceCore* core, grpc::CallbackServerContext* context,
                                     Rpc rpc, const std::string& resource,
                                     google::protobuf::Message* response, Call call,
                                     WorkerPool* pool) {
  auto* const reactor = new UnaryReactor(core->answers);
  const auto incoming = std::make_shared<IncomingCall>(core, *context, rpc);
  absl::Status admitted = incoming->identified();
  if (core->streams.draining()) {
    admitted = DrainingError();
  } else if (admitted.ok() &&
             pool->TryRun([reactor, context, incoming, resource, response, call = std::move(call)] {
               const TraceScope scope(incoming->trace());
               reactor->Finish(incoming->Finish(Guarded([&] {
                 const UnaryCancellation cancellation(context);
                 HOMING_RETURN_IF_ERROR(CheckAwaited(&cancellation));
                 absl::Status allowed = incoming->Authorize(resource);
                 if (!allowed.ok()) return allowed;
                 if constexpr (std::is_invocable_v<Call, JourneyFilter, const IncomingCall&>) {
                   HOMING_RETURN_IF_ERROR(call(incoming->filter(), *incoming));
                 } else {
                   HOMING_RETURN_IF_ERROR(call(incoming->filter()));
                 }
                 return reactor->Hold(response);
               })));
             })) {
    return reactor;
  } else if (admitted.ok()) {
    admitted = BusyError();
  }
  reactor->Finish(incoming->Finish(admitted));
  return reactor;
}

template <typename Call>
grpc::ServerUnaryReactor* ServeUnary(ServiceCore* core, grpc::CallbackServerContext* context,
                                     Rpc rpc, const std::string& resource,
                                     google::protobuf::Message* response, Call call) {
  return ServeUnary(core, context, rpc, resource, response, std::move(call), &core->pool);
}

}  // namespace homing::server

#endif  // SERVER_RPC_UNARY_CALL_H_
