// What every handler has of its call: who calls, what that caller may, what is counted.
#ifndef SERVER_RPC_INCOMING_CALL_H_
#define SERVER_RPC_INCOMING_CALL_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <atomic>
#include <string>

#include "absl/status/status.h"
#include "homing/base/mutex.h"
#include "server/access/authorization.h"
#include "server/admission/stream_limiter.h"
#include "server/rpc/service_core.h"

namespace homing::server {

class IncomingCall {
 public:
  // On gRPC's thread, at the beginning of the method.
  IncomingCall(ServiceCore* core, const grpc::ServerContextBase& context, Rpc rpc);
  // A call that was not finished counts as CANCELLED.
  ~IncomingCall();
  IncomingCall(const IncomingCall&) = delete;
  IncomingCall& operator=(const IncomingCall&) = delete;

  // UNAUTHENTICATED: who calls is not known.
  const absl::Status& identified() const { return identified_; }
  // The same now: UNAUTHENTICATED also if a token, certificate or role was taken away since.
  absl::Status CheckIdentity() const;
  // A stream takes its place among those open. RESOURCE_EXHAUSTED.
  absl::Status EnterStream();
  // May the caller do this to `resource`? As server::Authorize; in streams also the limit of
  // streams of that robot. Not on gRPC's threads: it may look into the store.
  absl::Status Authorize(const std::string& resource);
  // Which journeys of a pattern the caller gets.
  JourneyFilter filter() const { return JourneysFor(caller_, rpc_); }
  // One observation more. RESOURCE_EXHAUSTED: they come too fast.
  absl::Status TakeObservation();

  // The end of the call, counted; once.
  grpc::Status Finish(const absl::Status& status);

 private:
  ServiceCore* const core_;
  const Rpc rpc_;
  const TimePoint begin_;
  Credentials credentials_;
  absl::Status identified_;
  Caller caller_;
  // Whose limits apply: the caller's, or, when nobody is asked who they are, the robot named.
  std::string robot_;
  // As robot_. A call that names no robot has a key that no other call has: robots that localise on
  // a wildcard do not use up each other's rate.
  std::string rate_key_;
  std::atomic<bool> finished_ = false;

  Mutex mutex_;
  bool is_stream_ HOMING_GUARDED_BY(mutex_) = false;
  StreamLimiter::Place place_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_RPC_INCOMING_CALL_H_
