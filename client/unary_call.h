// Sends one request, and retries it while the server is not available.
#ifndef CLIENT_UNARY_CALL_H_
#define CLIENT_UNARY_CALL_H_

#include <grpcpp/client_context.h>

#include <chrono>
#include <functional>
#include <stop_token>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/rpc_status.h"

namespace homing::client {

// Longest time of one attempt.
inline constexpr std::chrono::seconds kCallDeadline{60};

// As Connection::Retry; DEADLINE_EXCEEDED after kCallDeadline.
template <typename Response>
absl::StatusOr<Response> CallUnary(
    const Connection& connection, const std::stop_token& stop,
    const std::function<grpc::Status(grpc::ClientContext*, Response*)>& call) {
  Response response;
  absl::Status status = connection.Retry(stop, [&] {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kCallDeadline);
    const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
    return FromGrpc(call(&context, &response));
  });
  if (!status.ok()) return status;
  return response;
}

}  // namespace homing::client

#endif  // CLIENT_UNARY_CALL_H_
