#include "tests/client/fake_journey_service.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <chrono>
#include <deque>
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

const grpc::Status kReset(grpc::StatusCode::INTERNAL, "Received RST_STREAM with error code 2");

// What arrives through a proxy that resets the link once `most` observations have arrived, whether
// they are computed or not. Each takes 20 ms.
template <typename Stream, typename Request>
class ProxyLink {
 public:
  ProxyLink(Stream* stream, int most)
      : most_(most), reader_([this, stream] { ReadAhead(stream); }) {}
  // The link was reset or has ended.
  ~ProxyLink() { reader_.join(); }

  // False: the link was reset or has ended.
  bool Read(Request* request) {
    const MutexLock lock(mutex_);
    while (waiting_.empty() && !ended_) changed_.Wait(mutex_);
    const auto computed = std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
    while (!ended_ && changed_.WaitUntil(mutex_, computed)) {
    }
    if (arrived_ == most_ || waiting_.empty()) return false;
    *request = std::move(waiting_.front());
    waiting_.pop_front();
    return true;
  }
  grpc::Status status() const {
    const MutexLock lock(mutex_);
    return arrived_ == most_ ? kReset : grpc::Status::OK;
  }

 private:
  void ReadAhead(Stream* stream) {
    Request request;
    bool more = true;
    while (more) {
      more = stream->Read(&request);
      const MutexLock lock(mutex_);
      if (more) {
        waiting_.push_back(request);
        more = ++arrived_ < most_;
      }
      ended_ = !more;
      changed_.NotifyAll();
    }
  }

  const int most_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::deque<Request> waiting_ HOMING_GUARDED_BY(mutex_);
  int arrived_ HOMING_GUARDED_BY(mutex_) = 0;
  bool ended_ HOMING_GUARDED_BY(mutex_) = false;
  std::thread reader_;
};

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
  if (faults_.proxy_resets_after > 0) {
    ProxyLink<RecordStream, v1::RecordJourneyRequest> proxy(stream, faults_.proxy_resets_after);
    while (proxy.Read(&request)) {
      Store(request.observation());
      Answer(stream, request.observation().sequence());
    }
    return proxy.status();
  }
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

void FakeJourneyService::AnswerHome(HomeStream* stream, std::int64_t sequence) {
  v1::LocalizeResponse answer;
  answer.set_sequence(sequence);
  if (faults_.lie_home) faults_.lie_home(&answer);
  stream->Write(answer);
}

grpc::Status FakeJourneyService::Localize(
    grpc::ServerContext* context,
    grpc::ServerReaderWriter<v1::LocalizeResponse, v1::LocalizeRequest>* stream) {
  const int link = BeginLink();
  if (link < faults_.silent_links) return AwaitCancellation(*context);
  const int break_after = BreakAfter(link);
  v1::LocalizeRequest request;
  stream->Read(&request);
  if (faults_.proxy_resets_after > 0) {
    ProxyLink<HomeStream, v1::LocalizeRequest> proxy(stream, faults_.proxy_resets_after);
    while (proxy.Read(&request)) AnswerHome(stream, request.observation().sequence());
    return proxy.status();
  }
  int received = 0;
  while (break_after != received && stream->Read(&request)) {
    if (request.observation().sequence() != received) {
      return {grpc::StatusCode::OUT_OF_RANGE, "gap in sequence"};
    }
    ++received;
    AnswerHome(stream, request.observation().sequence());
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
