// A call with one request and one answer. It runs in worker pools, so that I/O threads never
// compute.
#ifndef SERVER_RPC_UNARY_CALL_H_
#define SERVER_RPC_UNARY_CALL_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "homing/base/status_macros.h"
#include "server/base/memory_budget.h"
#include "server/base/trace_scope.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

// gRPC hands the call over when its headers have arrived: its caller is known before a byte of the
// request is read. The call owns itself until gRPC calls OnDone.
class UnaryCall final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                        public OpenStream,
                        public std::enable_shared_from_this<UnaryCall> {
 public:
  using Ptr = std::shared_ptr<UnaryCall>;
  using Message = google::protobuf::Message;
  // Runs once the request is read.
  using Handler = std::function<void(const Ptr& call, const Message& request, Message* response)>;

  // `request` and `response` are empty.
  UnaryCall(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc,
            std::unique_ptr<Message> request, std::unique_ptr<Message> response, Handler handler);

  void Open();
  void Drain() override { EndUnread(DrainingError()); }
  // Ends the call if its request does not arrive.
  void Tick() override;
  void OnReadDone(bool ok) override;
  void OnDone() override;

  IncomingCall& incoming() { return incoming_; }
  // Whether the client still waits for its answer.
  const Cancellation* cancellation() const { return &watch_; }
  void End(const absl::Status& status);
  // Runs `work` in `pool` if the client still waits by then, and calls `then` with its status.
  template <typename Work, typename Then>
  void RunIn(WorkerPool* pool, Work work, Then then) {
    auto task = [self = shared_from_this(), work = std::move(work), then = std::move(then)] {
      const TraceScope scope(self->incoming_.trace());
      then(Guarded([&] {
        HOMING_RETURN_IF_ERROR(CheckAwaited(&self->watch_));
        return work();
      }));
    };
    if (!pool->TryRun(std::move(task), incoming_.turn_key())) End(BusyError());
  }

 private:
  // The caller is known, and few enough of its requests are on their way.
  absl::Status Admit();
  void EndUnread(const absl::Status& status);
  // Counts the answer's memory until gRPC has sent it. RESOURCE_EXHAUSTED: clients have called
  // often and read too little.
  absl::Status Hold();
  // Counts the request's memory until the call ends. RESOURCE_EXHAUSTED.
  absl::Status HoldRequest();

  ServiceCore* const core_;
  // The call may end after the server's other objects.
  const std::shared_ptr<MemoryBudget> answers_;
  MemoryBudget::Share share_;
  IncomingCall incoming_;
  RequestMemory::Share request_share_;
  StreamWatch watch_;
  const Handler handler_;
  const TimePoint opened_;
  std::unique_ptr<Message> request_;
  std::unique_ptr<Message> response_;
  grpc::ByteBuffer bytes_;
  std::atomic<bool> unread_ = true;
  StreamLimiter::Slot unread_slot_;
  Ptr self_;
};

// What a call does after the part that waits for the store. No work: nothing.
struct SecondPart {
  std::function<absl::Status()> work;
  // Of the core.
  WorkerPool* pool = nullptr;
};

// `work` is absl::Status(const JourneyFilter&), or takes the IncomingCall too. It runs only if the
// caller may do this to `resource`, and may use the call's request and response. For a pattern it
// must apply the filter. `pool` belongs to the core. With a second part, `work` only waits for the
// store.
template <typename Work>
void ServeUnary(const UnaryCall::Ptr& call, const std::string& resource, Work work,
                WorkerPool* pool, SecondPart second = {}) {
  const auto end = [call](const absl::Status& status) { call->End(status); };
  call->RunIn(
      pool,
      [call, resource, work = std::move(work)]() -> absl::Status {
        IncomingCall& incoming = call->incoming();
        HOMING_RETURN_IF_ERROR(incoming.Authorize(resource));
        if constexpr (std::is_invocable_v<Work, JourneyFilter, const IncomingCall&>) {
          return work(incoming.filter(), incoming);
        } else {
          return work(incoming.filter());
        }
      },
      [call, end, second = std::move(second)](const absl::Status& status) {
        if (status.ok() && second.work) {
          call->RunIn(second.pool, second.work, end);
        } else {
          end(status);
        }
      });
}

}  // namespace homing::server

#endif  // SERVER_RPC_UNARY_CALL_H_
