// A server that keeps the durable contract of RecordJourney and breaks links as `Faults` says.
#ifndef TESTS_CLIENT_FAKE_JOURNEY_SERVICE_H_
#define TESTS_CLIENT_FAKE_JOURNEY_SERVICE_H_

#include <grpcpp/server.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "homing/base/mutex.h"
#include "homing/v1/homing_service.grpc.pb.h"
#include "homing/v1/journey_service.grpc.pb.h"

namespace homing::client {

struct Faults {
  // A link breaks after it received this many observations; -1: never. One entry a link, in order.
  std::vector<int> break_after_received;
  // How many of those received before the break were stored without being answered.
  int unanswered_at_break = 0;
  // Answers come twice.
  bool duplicate_answers = false;
  // Links before this one tell a wrong resend_from, so that a gap arises.
  int gap_links = 0;
  // Earlier observations that the server asks for again.
  int look_back = 1;
  // A link ends without an error instead of breaking.
  bool breaks_silently = false;
  // A proxy between: it resets a link that brings so many observations, and what the server has not
  // computed yet, 20 ms each, is lost. 0: none.
  int proxy_resets_after = 0;
  // So many links are accepted, and never answer.
  int silent_links = 0;
  // Nothing is stored.
  bool forgets = false;
  // Changes each answer.
  std::function<void(v1::RecordJourneyResponse*)> lie;
  std::function<void(v1::LocalizeResponse*)> lie_home;
  grpc::Status refuse = grpc::Status::OK;
};

class FakeJourneyService : public v1::JourneyService::Service, public v1::HomingService::Service {
 public:
  explicit FakeJourneyService(Faults faults) : faults_(std::move(faults)) {}

  grpc::Status RecordJourney(grpc::ServerContext* context,
                             grpc::ServerReaderWriter<v1::RecordJourneyResponse,
                                                      v1::RecordJourneyRequest>* stream) override;
  grpc::Status Localize(
      grpc::ServerContext* context,
      grpc::ServerReaderWriter<v1::LocalizeResponse, v1::LocalizeRequest>* stream) override;

  // The durable observations, in the order stored.
  std::vector<v1::Observation> stored() const;
  // Links begun.
  int links() const;
  // Largest number of observations received and not answered on one link.
  std::vector<std::int64_t> received() const;

 private:
  using RecordStream =
      grpc::ServerReaderWriter<v1::RecordJourneyResponse, v1::RecordJourneyRequest>;

  using HomeStream = grpc::ServerReaderWriter<v1::LocalizeResponse, v1::LocalizeRequest>;

  int BeginLink();
  int BreakAfter(int link) const;
  grpc::Status Broken() const;
  // False: a gap.
  bool Store(const v1::Observation& observation);
  void Answer(RecordStream* stream, std::int64_t sequence);
  void AnswerHome(HomeStream* stream, std::int64_t sequence);

  Faults faults_;
  mutable Mutex mutex_;
  int links_ = 0;
  std::vector<v1::Observation> stored_;
  std::vector<std::int64_t> received_;
};

// Listens on 127.0.0.1; `port` 0 picks one.
class FakeServer {
 public:
  explicit FakeServer(FakeJourneyService* service, int port = 0);
  ~FakeServer();
  int port() const { return port_; }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace homing::client

#endif  // TESTS_CLIENT_FAKE_JOURNEY_SERVICE_H_
