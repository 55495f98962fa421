#include "tests/client/fake_journey_service.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "homing/base/mutex.h"

namespace homing::client {
namespace {

const grpc::Status kLinkBroken(grpc::StatusCode::UNAVAILABLE, "link broken by the test");

// The client has given up.
grpc::Status AwaitCancellation(const grpc::ServerContext& context) {
  while (!context.IsCancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return kLinkBroken;
}

}  // namespace

int FakeJourneyService::BeginLink() {
  const MutexLock lock(mutex_);
  return links_++;
}

int FakeJourneyService::BreakAfter(int link) const {
  const auto index = static_cast<std::size_t>(link);
  return index < faults_.break_after_received.size() ? faults_.break_after_received[index] : -1;
}

bool FakeJourneyService::Store(const v1::Observation& observation) {
  const MutexLock lock(mutex_);
  received_.push_back(observation.sequence());
  const auto next = static_cast<std::int64_t>(stored_.size());
  if (faults_.forgets) return true;
  if (observation.sequence() > next) return false;
  if (observation.sequence() == next) stored_.push_back(observation);
  return true;
}

void FakeJourneyService::Answer(RecordStream* stream, std::int64_t sequence) {
  v1::RecordJourneyResponse answer;
  answer.set_sequence(sequence);
  answer.set_next_sequence(static_cast<std::int64_t>(stored().size()));
  if (faults_.lie) faults_.lie(&answer);
  stream->Write(answer);
}

grpc::Status FakeJourneyService::Broken() const {
  return faults_.breaks_silently ? grpc::Status::OK : kLinkBroken;
}

grpc::Status FakeJourneyService::RecordJourney(grpc::ServerContext* context, RecordStream* stream) {
  const int link = BeginLink();
  if (link < faults_.silent_links) return AwaitCancellation(*context);
  const int break_after = BreakAfter(link);
  if (!faults_.refuse.ok()) return faults_.refuse;
  v1::RecordJourneyRequest request;
  if (!stream->Read(&request) || !request.has_config()) {
    return {grpc::StatusCode::INVALID_ARGUMENT, "no config"};
  }
  const auto durable = static_cast<std::int64_t>(stored().size());
  v1::RecordJourneyResponse first;
  first.set_next_sequence(durable);
  first.set_resend_from(std::max<std::int64_t>(0, durable - faults_.look_back));
  if (link > 0 && link < faults_.gap_links) {
    first.set_next_sequence(durable + 1);
    first.set_resend_from(durable + 1);
  }
  stream->Write(first);
  int received = 0;
  while (break_after != received && stream->Read(&request)) {
    ++received;
    if (!Store(request.observation())) {
      return {grpc::StatusCode::OUT_OF_RANGE, "gap in sequence"};
    }
    const bool silent = break_after >= 0 && received > break_after - faults_.unanswered_at_break;
    if (silent) continue;
    Answer(stream, request.observation().sequence());
    if (faults_.duplicate_answers) Answer(stream, request.observation().sequence());
  }
  return break_after == received ? Broken() : grpc::Status::OK;
}

grpc::Status FakeJourneyService::Localize(
    grpc::ServerContext* context,
    grpc::ServerReaderWriter<v1::LocalizeResponse, v1::LocalizeRequest>* stream) {
  const int link = BeginLink();
  if (link < faults_.silent_links) return AwaitCancellation(*context);
  const int break_after = BreakAfter(link);
  v1::LocalizeRequest request;
  stream->Read(&request);
  int received = 0;
  while (break_after != received && stream->Read(&request)) {
    if (request.observation().sequence() != received) {
      return {grpc::StatusCode::OUT_OF_RANGE, "gap in sequence"};
    }
    ++received;
    v1::LocalizeResponse answer;
    answer.set_sequence(request.observation().sequence());
    if (faults_.lie_home) faults_.lie_home(&answer);
    stream->Write(answer);
  }
  return break_after == received ? Broken() : grpc::Status::OK;
}

std::vector<v1::Observation> FakeJourneyService::stored() const {
  const MutexLock lock(mutex_);
  return stored_;
}

int FakeJourneyService::links() const {
  const MutexLock lock(mutex_);
  return links_;
}

std::vector<std::int64_t> FakeJourneyService::received() const {
  const MutexLock lock(mutex_);
  return received_;
}

FakeServer::FakeServer(FakeJourneyService* service, int port) {
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:" + std::to_string(port), grpc::InsecureServerCredentials(),
                           &port_);
  builder.RegisterService(static_cast<v1::JourneyService::Service*>(service));
  builder.RegisterService(static_cast<v1::HomingService::Service*>(service));
  server_ = builder.BuildAndStart();
}

FakeServer::~FakeServer() {
  if (server_ != nullptr) server_->Shutdown(std::chrono::system_clock::now());
}

}  // namespace homing::client
