// A server in this process, on its own loopback port and database, and helpers for a client's
// actions.
#ifndef TESTS_SERVER_SERVER_FIXTURE_H_
#define TESTS_SERVER_SERVER_FIXTURE_H_

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "homing/flow/observation.h"
#include "homing/v1/deviation_model_service.grpc.pb.h"
#include "homing/v1/homing_service.grpc.pb.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "server/homing_server.h"
#include "tests/support/route.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {

inline constexpr char kJourney[] = "robots/r/journeys/out";
inline constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
inline constexpr char kWriter[] = "writer";

// StatusIs of a grpc::Status.
MATCHER_P2(GrpcStatusIs, code, message, "") {
  *result_listener << arg.error_code() << ": " << arg.error_message();
  return arg.error_code() == code &&
         ::testing::SafeMatcherCast<std::string>(message).Matches(arg.error_message());
}
MATCHER(IsGrpcOk, "is OK") {
  *result_listener << arg.error_code() << ": " << arg.error_message();
  return arg.ok();
}

// ErrorInfo's reason; empty when there are no details.
std::string ReasonOf(const grpc::Status& status);
bool HasRetryInfo(const grpc::Status& status);
// Calls again for up to 5 s while it is ABORTED: the server sees the end of a stream a moment after
// the client.
grpc::Status AfterStreamEnd(const std::function<grpc::Status()>& call);
// The field that BadRequest names.
std::string BadFieldOf(const grpc::Status& status);

v1::RecordJourneyRequest RecordRequest(const Observation& observation);
v1::LocalizeRequest LocalizeRequestOf(const Observation& observation);

// A RecordJourney stream.
class Recording {
 public:
  // Sends the config unless `journey` is empty.
  Recording(v1::JourneyService::Stub* stub, const std::string& journey,
            const std::string& writer = kWriter);

  bool Send(const v1::RecordJourneyRequest& request) { return stream_->Write(request); }
  bool Send(const Observation& observation) { return Send(RecordRequest(observation)); }
  // False at the end of the stream.
  bool Read(v1::RecordJourneyResponse* response) { return stream_->Read(response); }
  // Sends and reads one answer.
  v1::RecordJourneyResponse Record(const Observation& observation);
  // Reads the remaining answers without closing the sending side.
  grpc::Status AwaitEnd();
  // Closes the sending side, then reads the remaining answers.
  grpc::Status Close();
  const std::vector<v1::RecordJourneyResponse>& answers() const { return answers_; }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::RecordJourneyRequest, v1::RecordJourneyResponse>>
      stream_;
  std::vector<v1::RecordJourneyResponse> answers_;
};

// A Localize stream.
class Localizing {
 public:
  Localizing(v1::HomingService::Stub* stub, const v1::LocalizeConfig& config);

  bool Send(const Observation& observation) {
    return stream_->Write(LocalizeRequestOf(observation));
  }
  v1::LocalizeResponse Localize(const Observation& observation);
  grpc::Status AwaitEnd();
  grpc::Status Close();

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::LocalizeRequest, v1::LocalizeResponse>> stream_;
};

class ServerTest : public ::testing::Test {
 protected:
  ServerTest() { StartServer(); }

  // Again on the same database, after the server before has ended.
  void StartServer();
  void ConnectTo(const std::string& address);

  grpc::Status Create(const std::string& journey_id = "out", const std::string& writer = kWriter,
                      v1::Journey* made = nullptr);
  grpc::Status Finish(const std::string& name = kJourney, const std::string& writer = kWriter);
  v1::Journey Get(const std::string& name = kJourney);
  // The file of the journey; a failure when there is none.
  std::string Export(const std::string& name = kJourney);
  grpc::Status Import(const std::string& name, const std::string& file, std::size_t chunk = 1000);
  // Places [first, last) as flow vectors of both cameras.
  void RecordFlow(int first, int last, const std::string& name = kJourney);

  // Moves the server's steady clock.
  void Wait(std::chrono::seconds time) { *elapsed_s_ += time.count(); }

  TemporaryFolder folder_;
  ServerOptions options_;
  std::shared_ptr<std::atomic<std::int64_t>> elapsed_s_ =
      std::make_shared<std::atomic<std::int64_t>>(0);
  std::unique_ptr<HomingServer> server_;
  std::unique_ptr<v1::JourneyService::Stub> journeys_;
  std::unique_ptr<v1::HomingService::Stub> homing_;
  std::unique_ptr<v1::DeviationModelService::Stub> models_;
};

v1::LocalizeConfig LocalizeOn(const std::string& journey, v1::Travel travel = v1::TRAVEL_SAME);

}  // namespace homing::server

#endif  // TESTS_SERVER_SERVER_FIXTURE_H_
