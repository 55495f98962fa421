// Runs one unary RPC in worker pools, so that I/O threads never compute.
#ifndef SERVER_RPC_UNARY_CALL_H_
#define SERVER_RPC_UNARY_CALL_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/server_callback.h>

#include <functional>
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

// One unary call, until it is answered.
class UnaryCall : public std::enable_shared_from_this<UnaryCall> {
 public:
  UnaryCall(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc,
            google::protobuf::Message* response)
      : core_(core),
        context_(context),
        response_(response),
        reactor_(new UnaryReactor(core->answers)),
        incoming_(core, *context, rpc) {}

  grpc::ServerUnaryReactor* reactor() { return reactor_; }
  IncomingCall& incoming() { return incoming_; }
  // The caller is known, and the server does not drain.
  absl::Status Admit() const {
    return core_->streams.draining() ? DrainingError() : incoming_.identified();
  }
  void Finish(const absl::Status& status) {
    reactor_->Finish(incoming_.Finish(status.ok() ? reactor_->Hold(response_) : status));
  }
  // Runs `work` in `pool` if the client still waits by then, and calls `end` with its status.
  template <typename Work, typename End>
  void RunIn(WorkerPool* pool, Work work, End end) {
    auto task = [self = shared_from_this(), work = std::move(work), end = std::move(end)] {
      const TraceScope scope(self->incoming_.trace());
      end(Guarded([&] {
        const UnaryCancellation cancellation(self->context_);
        HOMING_RETURN_IF_ERROR(CheckAwaited(&cancellation));
        return work();
      }));
    };
    if (!pool->TryRun(std::move(task))) Finish(BusyError());
  }

 private:
  ServiceCore* const core_;
  grpc::CallbackServerContext* const context_;
  google::protobuf::Message* const response_;
  // Owns itself.
  UnaryReactor* const reactor_;
  IncomingCall incoming_;
};

// What a call does after the part that waits for the store. No work: nothing.
struct SecondPart {
  std::function<absl::Status()> work;
  // Of the core.
  WorkerPool* pool = nullptr;
};

// `call` is absl::Status(const JourneyFilter&), or takes the IncomingCall too. It runs only if the
// caller may do this to `resource`, and may use the RPC's request and `response`, which outlive it.
// For a pattern it must apply the filter. `pool` belongs to the core. With a second part, `call`
// only waits for the store.
template <typename Call>
grpc::ServerUnaryReactor* ServeUnary(ServiceCore* core, grpc::CallbackServerContext* context,
                                     Rpc rpc, const std::string& resource,
                                     google::protobuf::Message* response, Call call,
                                     WorkerPool* pool, SecondPart second = {}) {
  const auto unary = std::make_shared<UnaryCall>(core, context, rpc, response);
  const auto finish = [unary](const absl::Status& status) { unary->Finish(status); };
  if (const absl::Status admitted = unary->Admit(); !admitted.ok()) {
    finish(admitted);
    return unary->reactor();
  }
  unary->RunIn(
      pool,
      [unary, resource, call = std::move(call)]() -> absl::Status {
        IncomingCall& incoming = unary->incoming();
        HOMING_RETURN_IF_ERROR(incoming.Authorize(resource));
        if constexpr (std::is_invocable_v<Call, JourneyFilter, const IncomingCall&>) {
          return call(incoming.filter(), incoming);
        } else {
          return call(incoming.filter());
        }
      },
      [unary, finish, second = std::move(second)](const absl::Status& status) {
        if (status.ok() && second.work) {
          unary->RunIn(second.pool, second.work, finish);
        } else {
          finish(status);
        }
      });
  return unary->reactor();
}

}  // namespace homing::server

#endif  // SERVER_RPC_UNARY_CALL_H_
