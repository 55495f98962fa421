// The part that all handlers share: the caller, its rights, limits and metrics.
#ifndef SERVER_RPC_INCOMING_CALL_H_
#define SERVER_RPC_INCOMING_CALL_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <atomic>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "homing/base/mutex.h"
#include "homing/base/trace_parent.h"
#include "server/access/authorization.h"
#include "server/admission/stream_limiter.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Belongs to one call. Several threads may use it, one after the other; Finish is thread-safe.
class IncomingCall {
 public:
  // Runs on gRPC's thread when the method begins.
  IncomingCall(ServiceCore* core, const grpc::ServerContextBase& context, Rpc rpc);
  // A call that did not finish counts as CANCELLED.
  ~IncomingCall();
  IncomingCall(const IncomingCall&) = delete;
  IncomingCall& operator=(const IncomingCall&) = delete;

  // UNAUTHENTICATED: the caller has no valid credentials.
  const absl::Status& identified() const { return identified_; }
  // Empty without credentials.
  const std::string& identity() const { return caller_.identity; }
  // Who takes turns with others: the identity, or without credentials the connection.
  const std::string& turn_key() const { return turn_key_; }
  // Checks again: UNAUTHENTICATED also if the token, certificate or role was withdrawn since.
  absl::Status CheckIdentity() const;
  // Counts the call as an open stream. RESOURCE_EXHAUSTED.
  absl::Status EnterStream();
  // As EnterStream, for a stream that only watches: it counts in the total and among the caller's
  // watches, but not among the robot's streams.
  absl::Status EnterWatch();
  // Checks that the caller may do this to `resource`, as server::Authorize; for a stream also the
  // robot's limit of streams. Not for gRPC's threads: it may read the store.
  absl::Status Authorize(const std::string& resource);
  // Selects the journeys of a pattern that the caller may use.
  JourneyFilter filter() const { return JourneysFor(caller_, rpc_); }
  // The caller may see the live state of `robot`.
  bool SeesRobot(const std::string& robot) const { return server::SeesRobot(caller_, robot); }
  // "robots/r": the caller if it is a robot, else the robot that the request says or that its
  // journey names; empty: none.
  std::string RobotOf(const std::string& said, const std::string& journey) const;
  // The trace that the client names, for a TraceScope; null: none.
  const TraceParent* trace() const { return trace_ ? &*trace_ : nullptr; }
  // Counts one observation. RESOURCE_EXHAUSTED: the robot's rate is too high.
  absl::Status TakeObservation();

  // Ends and counts the call, once.
  grpc::Status Finish(const absl::Status& status);

 private:
  ServiceCore* const core_;
  const Rpc rpc_;
  const TimePoint begin_;
  const std::optional<TraceParent> trace_;
  Credentials credentials_;
  absl::Status identified_;
  Caller caller_;
  std::string turn_key_;
  // The robot whose limits apply: the caller, or, without credentials, the robot named.
  std::string robot_;
  // The key of the robot's rate limit: robot_. A call that names no robot has a key that no other
  // call has: robots that localise on a wildcard do not use up each other's rate.
  std::string rate_key_;
  std::atomic<bool> finished_ = false;

  Mutex mutex_;
  // The resource, for the log.
  std::string resource_ HOMING_GUARDED_BY(mutex_);
  bool is_stream_ HOMING_GUARDED_BY(mutex_) = false;
  StreamLimiter::Slot slot_ HOMING_GUARDED_BY(mutex_);
  StreamLimiter::Slot watch_slot_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_RPC_INCOMING_CALL_H_
