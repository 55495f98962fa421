#include "server/rpc/incoming_call.h"

#include <grpc/grpc_security_constants.h>
#include <grpcpp/security/auth_context.h>
#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/base/trace_scope.h"
#include "server/rpc/library_log.h"
#include "server/rpc/status_conversion.h"

namespace homing::server {
namespace {

// Bytes of a resource's name in the log.
constexpr std::size_t kMaxShown = 200;

std::string TextOf(const grpc::string_ref& text) { return std::string(text.data(), text.size()); }

std::vector<std::string> Properties(const grpc::AuthContext& context, const char* name) {
  std::vector<std::string> values;
  for (const grpc::string_ref& value : context.FindPropertyValues(name)) {
    values.push_back(TextOf(value));
  }
  return values;
}

Credentials CredentialsOf(const grpc::ServerContextBase& context) {
  Credentials credentials;
  const auto [begin, end] = context.client_metadata().equal_range("authorization");
  for (auto header = begin; header != end; ++header) {
    credentials.authorizations.push_back(TextOf(header->second));
  }
  if (const auto peer = context.auth_context()) {
    credentials.uris = Properties(*peer, GRPC_PEER_URI_PROPERTY_NAME);
    // OpenSSL's chain does not hold the client's own certificate.
    for (const char* part :
         {GRPC_X509_PEM_CERT_PROPERTY_NAME, GRPC_X509_PEM_CERT_CHAIN_PROPERTY_NAME}) {
      const auto pem = Properties(*peer, part);
      credentials.certificate_pem += pem.empty() ? "" : pem.front();
    }
  }
  return credentials;
}

std::optional<TraceParent> TraceOf(const grpc::ServerContextBase& context) {
  const auto found = context.client_metadata().find("traceparent");
  return found == context.client_metadata().end() ? std::nullopt
                                                  : ParseTraceParent(TextOf(found->second));
}

// Changes that an operator may ask about later; recording itself is not one.
bool IsAudited(Rpc rpc) {
  const Right right = TraitsOf(rpc).right;
  return right == Right::kDelete || right == Right::kTrain || right == Right::kBackUp ||
         (right == Right::kWrite && rpc != Rpc::kRecordJourney);
}

// "robots/r" in the name of a resource; empty if it does not name one robot.
std::string RobotNamed(const std::string& resource) {
  const std::size_t slash = resource.find('/');
  const std::string robot = resource.substr(0, resource.find('/', slash + 1));
  return slash == std::string::npos || robot == "robots/-" ? "" : robot;
}

}  // namespace

IncomingCall::IncomingCall(ServiceCore* core, const grpc::ServerContextBase& context, Rpc rpc)
    : core_(core), rpc_(rpc), begin_(std::chrono::steady_clock::now()), trace_(TraceOf(context)) {
  core_->metrics->CallStarted(rpc_);
  if (!core_->access->is_open()) {
    credentials_ = CredentialsOf(context);
  }
  absl::StatusOr<Caller> caller = core_->access->Identify(credentials_);
  identified_ = caller.status();
  if (caller.ok()) {
    caller_ = *std::move(caller);
    robot_ = caller_.identity;
  }
  turn_key_ = caller_.identity.empty() ? context.peer() : caller_.identity;
  static std::atomic<std::int64_t> calls = 0;
  rate_key_ = robot_.empty() ? absl::StrCat("call/", ++calls) : robot_;
}

IncomingCall::~IncomingCall() {
  if (!finished_) {
    Finish(absl::CancelledError("the client disconnected"));
  }
}

absl::Status IncomingCall::CheckIdentity() const {
  HOMING_RETURN_IF_ERROR(identified_);
  if (core_->access->is_open()) {
    return absl::OkStatus();
  }
  HOMING_ASSIGN_OR_RETURN(const Caller now, core_->access->Identify(credentials_));
  if (now.identity != caller_.identity || now.role != caller_.role) {
    return WithReason(absl::UnauthenticatedError("the caller's role was changed; call again"),
                      {"ROLE_CHANGED", {}});
  }
  return absl::OkStatus();
}

absl::Status IncomingCall::EnterStream() {
  HOMING_RETURN_IF_ERROR(identified_);
  const MutexLock lock(mutex_);
  is_stream_ = true;
  slot_.Leave();
  HOMING_ASSIGN_OR_RETURN(slot_, core_->slots.Enter(robot_));
  return absl::OkStatus();
}

absl::Status IncomingCall::EnterWatch() {
  HOMING_RETURN_IF_ERROR(identified_);
  const MutexLock lock(mutex_);
  auto watch = core_->watches.Enter(caller_.identity);
  if (!watch.ok()) {
    return WithReason(absl::ResourceExhaustedError(
                          absl::StrCat(caller_.identity, " has ", ServiceCore::kMaxWatchesOfCaller,
                                       " streams open that watch robots: these are the most")),
                      {"WATCHES", {}});
  }
  watch_slot_ = *std::move(watch);
  HOMING_ASSIGN_OR_RETURN(slot_, core_->slots.Enter(""));
  return absl::OkStatus();
}

std::string IncomingCall::RobotOf(const std::string& said, const std::string& journey) const {
  if (!caller_.robot().empty()) return caller_.identity;
  return said.empty() ? RobotNamed(journey) : said;
}

absl::Status IncomingCall::Authorize(const std::string& resource) {
  HOMING_RETURN_IF_ERROR(identified_);
  {
    const MutexLock lock(mutex_);
    resource_ = absl::CHexEscape(resource.substr(0, kMaxShown));
  }
  HOMING_RETURN_IF_ERROR(server::Authorize(caller_, rpc_, resource, &core_->catalog));
  if (core_->access->is_open()) {
    robot_ = RobotNamed(resource);
    rate_key_ = robot_.empty() ? rate_key_ : robot_;
    {
      const MutexLock lock(mutex_);
      if (!is_stream_) {
        return absl::OkStatus();
      }
    }
    return EnterStream();
  }
  return absl::OkStatus();
}

absl::Status IncomingCall::TakeObservation() {
  core_->metrics->ObservationReceived(rpc_);
  return core_->rates.Take(rate_key_, core_->options.clock());
}

grpc::Status IncomingCall::Finish(const absl::Status& status) {
  const TraceScope scope(trace());
  if (!finished_.exchange(true)) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    core_->metrics->CallEnded(rpc_, status, elapsed.count());
    const MutexLock lock(mutex_);
    if (IsAudited(rpc_)) {
      const std::string line =
          absl::StrCat("audit: ", caller_.identity.empty() ? "-" : caller_.identity, " ",
                       std::string(TraitsOf(rpc_).method), " \"", resource_,
                       "\": ", absl::StatusCodeToString(status.code()));
      if (identified_.ok()) {
        spdlog::info("{}", line);
      } else {
        LogOfStranger(line);
      }
    }
    // The client records the trace, so each of its calls gets a log line. A stranger cannot fill
    // the log with them.
    if (trace_ && IsSampled(*trace_) && identified_.ok()) {
      spdlog::info("call: {} \"{}\": {} in {:.6f} s", TraitsOf(rpc_).method, resource_,
                   absl::StatusCodeToString(status.code()), elapsed.count());
    }
    slot_.Leave();
    watch_slot_.Leave();
  }
  return ToGrpcStatus(status);
}

}  // namespace homing::server
