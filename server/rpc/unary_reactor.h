// Ends a unary call, and counts its answer's memory until gRPC has sent it.
#ifndef SERVER_RPC_UNARY_REACTOR_H_
#define SERVER_RPC_UNARY_REACTOR_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/server_callback.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "server/base/error_reason.h"
#include "server/base/memory_budget.h"

namespace homing::server {

// Owns itself until gRPC calls OnDone, which it does once the answer is sent or the client is away.
class UnaryReactor final : public grpc::ServerUnaryReactor {
 public:
  explicit UnaryReactor(std::shared_ptr<MemoryBudget> answers)
      : answers_(std::move(answers)), share_(answers_.get()) {}

  // RESOURCE_EXHAUSTED: clients have called often and read too little; the answer is emptied.
  absl::Status Hold(google::protobuf::Message* answer) {
    // The message, its bytes, and what gRPC makes of them.
    constexpr std::int64_t kCopies = 3;
    const auto bytes = static_cast<std::int64_t>(answer->ByteSizeLong());
    if (share_.TrySet(kCopies * bytes)) return absl::OkStatus();
    // Clear() would keep the memory.
    const std::unique_ptr<google::protobuf::Message> empty(answer->New());
    answer->GetReflection()->Swap(answer, empty.get());
    return WithReason(
        absl::ResourceExhaustedError(absl::StrCat("this answer of ", bytes,
                                                  " bytes and those that clients have not read "
                                                  "yet need more than memory-quota, ",
                                                  answers_->most(), " bytes")),
        {"ANSWER_MEMORY", {}});
  }

  void OnDone() override { delete this; }

 private:
  // A call may end after the server's other objects.
  const std::shared_ptr<MemoryBudget> answers_;
  MemoryBudget::Share share_;
};

}  // namespace homing::server

#endif  // SERVER_RPC_UNARY_REACTOR_H_
