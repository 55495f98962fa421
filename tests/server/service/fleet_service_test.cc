// FleetService over a real socket: who is seen, and that watchers hear of changes at once.
#include "homing/v1/fleet_service.grpc.pb.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "server/access/token_book.h"
#include "tests/server/server_fixture.h"
#include "tests/support/connected.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class FleetServiceTest : public ServerTest {
 protected:
  std::unique_ptr<v1::FleetService::Stub> Fleet() {
    return v1::FleetService::NewStub(ConnectedChannel(server_->address()));
  }
  std::vector<v1::Robot> Robots(const std::string& token = "") {
    grpc::ClientContext context;
    if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
    v1::ListRobotsResponse response;
    EXPECT_THAT(Fleet()->ListRobots(&context, {}, &response), IsGrpcOk());
    return {response.robots().begin(), response.robots().end()};
  }
  // A stream is left shortly after its client has read its end.
  std::vector<v1::Robot> RobotsAllOffline() {
    std::vector<v1::Robot> robots;
    for (int i = 0; i < 200; ++i) {
      robots = Robots();
      if (std::ranges::all_of(robots, [](const v1::Robot& robot) {
            return robot.activity() == v1::ACTIVITY_OFFLINE;
          })) {
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return robots;
  }
  v1::LocalizeConfig As(const std::string& robot) {
    v1::LocalizeConfig config = LocalizeOn(kJourney);
    config.set_robot(robot);
    return config;
  }
};

// Watches in the test's own thread.
template <typename Reader, typename Response, typename Done>
bool ReadUntil(Reader* reader, Response* response, Done done) {
  while (reader->Read(response)) {
    if (done(*response)) return true;
  }
  return false;
}

TEST_F(FleetServiceTest, ARobotIsListedWithWhatItDoesAndStaysWhenItIsOffline) {
  EXPECT_TRUE(Robots().empty());
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 30);
  std::vector<v1::Robot> robots = RobotsAllOffline();
  ASSERT_EQ(robots.size(), 1);
  EXPECT_EQ(robots[0].name(), "robots/r");
  EXPECT_EQ(robots[0].activity(), v1::ACTIVITY_OFFLINE);
  EXPECT_EQ(robots[0].journey_count(), 1);
  EXPECT_EQ(robots[0].recorded_steps(), 30);
  {
    Localizing localizing(homing_.get(), As("robots/other"));
    localizing.Localize(test::FlowAt(0));
    localizing.Localize(test::FlowAt(1));
    robots = Robots();
    ASSERT_EQ(robots.size(), 2);
    EXPECT_EQ(robots[0].name(), "robots/other");
    EXPECT_EQ(robots[0].activity(), v1::ACTIVITY_LOCALIZING);
    EXPECT_EQ(robots[0].journey(), kJourney);
    EXPECT_EQ(robots[0].observation_count(), 2);
    EXPECT_EQ(robots[0].answer().sequence(), 1);
    EXPECT_EQ(robots[0].answer().matches_size(), 0);
    EXPECT_THAT(localizing.Close(), IsGrpcOk());
  }
  StartServer();
  robots = Robots();
  ASSERT_EQ(robots.size(), 1);
  EXPECT_EQ(robots[0].journey_count(), 1);
  EXPECT_TRUE(robots[0].has_last_seen());
}

TEST_F(FleetServiceTest, ANameThatIsRefusedIsNoRobot) {
  grpc::ClientContext context;
  const auto stream = journeys_->RecordJourney(&context);
  v1::RecordJourneyRequest request;
  request.mutable_config()->set_journey("x7/" + std::string(100'000, 'A'));
  stream->Write(request);
  v1::RecordJourneyResponse response;
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(Robots().empty());
}

TEST_F(FleetServiceTest, AWatcherOfTheFleetSeesALostRobotWithinASecond) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 60);
  const auto fleet = Fleet();
  grpc::ClientContext context;
  const auto reader = fleet->WatchFleet(&context, {});
  v1::WatchFleetResponse response;
  ASSERT_TRUE(reader->Read(&response));
  ASSERT_EQ(response.robots_size(), 1);
  Localizing localizing(homing_.get(), As("robots/lost"));
  // Views from somewhere else: no place of this route.
  std::int64_t sequence = 0;
  v1::LocalizeResponse answer;
  for (int place = 5000; sequence < 200; place += 37) {
    answer = localizing.Localize(test::FlowAt(sequence++, place));
    if (answer.outcome() == v1::OUTCOME_UNKNOWN_PLACE) break;
  }
  ASSERT_EQ(answer.outcome(), v1::OUTCOME_UNKNOWN_PLACE);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(ReadUntil(reader.get(), &response, [](const v1::WatchFleetResponse& changed) {
    return changed.robots(0).name() == "robots/lost" && changed.robots(0).has_lost_since();
  }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
  context.TryCancel();
  reader->Finish();
}

TEST_F(FleetServiceTest, AWatcherOfARobotSeesItsAnswersAndItsEnd) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 60);
  const auto fleet = Fleet();
  grpc::ClientContext context;
  v1::WatchRobotRequest request;
  request.set_name("robots/home");
  const auto reader = fleet->WatchRobot(&context, request);
  v1::WatchRobotResponse response;
  ASSERT_TRUE(reader->Read(&response));
  EXPECT_EQ(response.robot().activity(), v1::ACTIVITY_OFFLINE);
  {
    Localizing localizing(homing_.get(), As("robots/home"));
    for (int i = 20; i < 40; ++i) localizing.Localize(test::FlowAt(i));
    EXPECT_TRUE(ReadUntil(reader.get(), &response, [](const v1::WatchRobotResponse& update) {
      return update.answer().sequence() == 39;
    }));
    EXPECT_THAT(localizing.Close(), IsGrpcOk());
  }
  EXPECT_TRUE(ReadUntil(reader.get(), &response, [](const v1::WatchRobotResponse& update) {
    return update.robot().activity() == v1::ACTIVITY_OFFLINE;
  }));
  server_->Drain();
  EXPECT_FALSE(reader->Read(&response));
  EXPECT_THAT(reader->Finish(),
              GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("shutting down")));
}

TEST_F(FleetServiceTest, ARobotSeesItselfAndCannotPassForAnother) {
  options_.tokens = folder_.File("tokens.toml");
  ASSERT_THAT(AddToken(options_.tokens, "robots/a", HashToken("secret-a")), IsOk());
  ASSERT_THAT(AddToken(options_.tokens, "operators/o", HashToken("secret-o")), IsOk());
  StartServer();
  const auto channel = ConnectedChannel(server_->address());
  const auto journeys = v1::JourneyService::NewStub(channel);
  for (const char* robot : {"a", "b"}) {
    grpc::ClientContext context;
    context.AddMetadata("authorization", "Bearer secret-a");
    v1::CreateJourneyRequest request;
    request.set_parent(std::string("robots/") + robot);
    request.set_journey_id("j");
    v1::Journey made;
    EXPECT_EQ(journeys->CreateJourney(&context, request, &made).ok(), robot[0] == 'a');
  }
  grpc::ClientContext context;
  context.AddMetadata("authorization", "Bearer secret-a");
  const auto stream = v1::HomingService::NewStub(channel)->Localize(&context);
  v1::LocalizeRequest config;
  *config.mutable_config() = LocalizeOn("robots/a/journeys/j");
  config.mutable_config()->set_robot("robots/b");
  stream->Write(config);
  stream->WritesDone();
  v1::LocalizeResponse answer;
  EXPECT_FALSE(stream->Read(&answer));
  EXPECT_THAT(stream->Finish(), IsGrpcOk());
  for (const char* token : {"secret-a", "secret-o"}) {
    const auto robots = Robots(token);
    ASSERT_EQ(robots.size(), 1);
    EXPECT_EQ(robots[0].name(), "robots/a");
  }
}

TEST_F(FleetServiceTest, ABadNameIsRefused) {
  grpc::ClientContext context;
  v1::WatchRobotRequest request;
  request.set_name("robots/-");
  const auto fleet = Fleet();
  const auto reader = fleet->WatchRobot(&context, request);
  v1::WatchRobotResponse response;
  EXPECT_FALSE(reader->Read(&response));
  EXPECT_THAT(reader->Finish(), GrpcStatusIs(kInvalid, HasSubstr("name")));
}

}  // namespace
}  // namespace homing::server
