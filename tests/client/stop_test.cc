// A stop ends the wait for a server that never answers.
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <sstream>
#include <stop_token>
#include <thread>

#include "client/homing_client.h"
#include "client/journey_client.h"
#include "client/live_localizer.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

// Waits in each call until the client cancels it.
class SilentServer final : public v1::JourneyService::Service, public v1::HomingService::Service {
 public:
  SilentServer() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(static_cast<v1::JourneyService::Service*>(this));
    builder.RegisterService(static_cast<v1::HomingService::Service*>(this));
    server_ = builder.BuildAndStart();
  }
  ~SilentServer() override { server_->Shutdown(std::chrono::system_clock::now()); }

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  // Requested once a call has arrived.
  std::stop_token stop() const { return stop_.get_token(); }

  grpc::Status MatchLandmarks(grpc::ServerContext* context, const v1::MatchLandmarksRequest*,
                              v1::MatchLandmarksResponse*) override {
    return Wait(context);
  }
  grpc::Status ExportJourney(grpc::ServerContext* context, const v1::ExportJourneyRequest*,
                             grpc::ServerWriter<v1::ExportJourneyResponse>*) override {
    return Wait(context);
  }
  grpc::Status ImportJourney(grpc::ServerContext* context,
                             grpc::ServerReader<v1::ImportJourneyRequest>*,
                             v1::ImportJourneyResponse*) override {
    return Wait(context);
  }
  grpc::Status Localize(
      grpc::ServerContext* context,
      grpc::ServerReaderWriter<v1::LocalizeResponse, v1::LocalizeRequest>*) override {
    return Wait(context);
  }

 private:
  grpc::Status Wait(grpc::ServerContext* context) {
    stop_.request_stop();
    while (!context->IsCancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return grpc::Status::CANCELLED;
  }

  int port_ = 0;
  std::stop_source stop_;
  std::unique_ptr<grpc::Server> server_;
};

class StopTest : public ::testing::Test {
 protected:
  StopTest() {
    ConnectionOptions options;
    options.address = server_.address();
    connection_.emplace(*Connection::Open(options));
  }

  SilentServer server_;
  std::optional<Connection> connection_;
};

TEST_F(StopTest, EndsACallWithOneAnswer) {
  EXPECT_TRUE(absl::IsCancelled(HomingClient(&*connection_).Match({}, server_.stop()).status()));
}

TEST_F(StopTest, EndsAnExportAndAnImport) {
  JourneyClient client(&*connection_, server_.stop());
  std::stringstream file("bytes");
  EXPECT_TRUE(absl::IsCancelled(client.Export("robots/r/journeys/a", file)));
  EXPECT_TRUE(absl::IsCancelled(client.Import("robots/r/journeys/a", file).status()));
}

TEST_F(StopTest, EndsTheWaitOfALiveRobot) {
  LiveLocalizer localizer(&*connection_, {});
  localizer.Send({});
  EXPECT_TRUE(absl::IsCancelled(localizer.Wait(server_.stop()).status()));
}

}  // namespace
}  // namespace homing::client
