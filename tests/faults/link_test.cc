// Links that break, hang or crawl between real clients and a real server.
#include <gmock/gmock.h>

#include <atomic>
#include <random>
#include <thread>

#include "client/homing_client.h"
#include "tests/faults/robot.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"
#include "tests/support/tcp_proxy.h"

namespace homing::faults {
namespace {

using server::GrpcStatusIs;
using server::IsGrpcOk;
using server::kJourney;
using server::kWriter;
using server::Recording;
using ::testing::HasSubstr;

class LinkTest : public server::ServerTest {
 protected:
  LinkTest() : link_(server_->address()) {
    robot_.address = link_.address();
    robot_.observations = 12;
    robot_.pace = std::chrono::milliseconds(0);
  }

  std::unique_ptr<v1::JourneyService::Stub> StubThroughLink() const {
    return v1::JourneyService::NewStub(
        grpc::CreateChannel(link_.address(), grpc::InsecureChannelCredentials()));
  }
  std::string Undisturbed() {
    RobotOptions direct = robot_;
    direct.address = server_->address();
    const std::string journey = "robots/calm/journeys/" + std::to_string(calm_journeys_++);
    EXPECT_THAT(RecordOne(direct, journey, &ledger_), IsOk());
    return Export(journey);
  }

  TcpProxy link_;
  RobotOptions robot_;
  Ledger ledger_;
  int calm_journeys_ = 0;
};

TEST_F(LinkTest, EachConnectionOfAProgramIsALinkOfItsOwn) {
  client::ConnectionOptions options;
  options.address = link_.address();
  const auto one = client::Connection::Open(options).value();
  const auto another = client::Connection::Open(options).value();
  EXPECT_THAT(one.WaitForServer(), IsOk());
  EXPECT_THAT(another.WaitForServer(), IsOk());
  EXPECT_EQ(link_.connections(), 2);
}

class CutTest : public LinkTest, public ::testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(Sent, CutTest, ::testing::Values(0, 1), [](const auto& sent) {
  return sent.param == 0 ? std::string("flow") : std::string("frames");
});

// The first connection breaks after this many bytes; the client continues on another.
TEST_P(CutTest, AtAnyByteTheMapIsTheSame) {
  robot_.robot = GetParam();
  const std::string expected = Undisturbed();
  const std::int64_t before = link_.bytes();
  ASSERT_THAT(RecordOne(robot_, "robots/uncut/journeys/0", &ledger_), IsOk());
  const std::int64_t all = link_.bytes() - before;
  std::mt19937 random(5);
  for (int trial = 0; trial < 24; ++trial) {
    const std::int64_t cut = trial < 4 ? 1 + 20 * trial : static_cast<std::int64_t>(random()) % all;
    link_.CutAfter(cut);
    const int connections = link_.connections();
    std::thread heal([&] {
      while (link_.connections() == connections) std::this_thread::yield();
      link_.CutAfter(-1);
    });
    const std::string journey = "robots/cut/journeys/" + std::to_string(trial);
    EXPECT_THAT(RecordOne(robot_, journey, &ledger_), IsOk()) << "cut after " << cut;
    heal.join();
    EXPECT_TRUE(Export(journey) == expected) << "cut after " << cut << " of " << all;
  }
}

TEST_F(LinkTest, ALinkThatIsCutAgainAndAgainOnlyTakesLonger) {
  robot_.observations = 200;
  robot_.pace = std::chrono::milliseconds(2);
  const std::string expected = Undisturbed();
  std::atomic<bool> done = false;
  std::thread cutter([&] {
    while (!done) {
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
      link_.CutAll();
    }
  });
  EXPECT_THAT(RecordOne(robot_, "robots/cut/journeys/0", &ledger_), IsOk());
  done = true;
  cutter.join();
  EXPECT_GT(link_.connections(), 1);
  EXPECT_TRUE(Export("robots/cut/journeys/0") == expected);
}

TEST_F(LinkTest, ARobotThatGoesHomeKnowsItsPlaceAfterACut) {
  robot_.observations = 200;
  robot_.pace = std::chrono::milliseconds(2);
  Undisturbed();
  const auto answers = [this](const std::string& address, std::int64_t cut_at) {
    client::ConnectionOptions connecting;
    connecting.address = address;
    const auto connection = client::Connection::Open(connecting).value();
    client::LocalizingOptions options;
    options.config = server::LocalizeOn("robots/calm/journeys/0");
    std::vector<v1::LocalizeResponse> all;
    EXPECT_THAT(client::HomingClient(&connection)
                    .Localize(options, RouteOf(robot_).get(),
                              [&](const v1::LocalizeResponse& answer) {
                                all.push_back(answer);
                                if (answer.sequence() == cut_at) link_.CutAll();
                                return absl::OkStatus();
                              }),
                IsOk());
    return all;
  };
  const auto whole = answers(server_->address(), -1);
  for (const std::int64_t cut : {30, 77, 140}) {
    const auto cut_off = answers(link_.address(), cut);
    ASSERT_EQ(cut_off.size(), whole.size());
    int unlike = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      unlike += cut_off[i].outcome() != whole[i].outcome();
      EXPECT_NEAR(static_cast<double>(cut_off[i].step()), static_cast<double>(whole[i].step()), 3)
          << "cut after " << cut << ", at " << i;
    }
    EXPECT_LE(unlike, 2) << cut;
    EXPECT_EQ(cut_off.back().outcome(), v1::OUTCOME_MATCH);
  }
}

// The robot drove out of reach: the server still believes in the old stream.
TEST_F(LinkTest, BehindAHalfOpenLinkTheSameWriterTakesOverAtOnce) {
  ASSERT_THAT(Create(), IsGrpcOk());
  const auto far = StubThroughLink();
  Recording lost(far.get(), kJourney);
  for (int i = 0; i < 5; ++i) lost.Record(test::FlowAt(i));
  link_.FreezeAll();
  Recording again(journeys_.get(), kJourney);
  EXPECT_EQ(again.Record(test::FlowAt(5)).next_sequence(), 6);
  EXPECT_THAT(again.Close(), IsGrpcOk());
  link_.CutAll();
  EXPECT_THAT(lost.AwaitEnd(), GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("")));
}

TEST_F(LinkTest, BehindAHalfOpenLinkAnotherWriterWaitsForTheLease) {
  ASSERT_THAT(Create(), IsGrpcOk());
  const auto far = StubThroughLink();
  Recording lost(far.get(), kJourney);
  for (int i = 0; i < 5; ++i) lost.Record(test::FlowAt(i));
  link_.FreezeAll();
  {
    Recording other(journeys_.get(), kJourney, "another");
    const grpc::Status refused = other.AwaitEnd();
    EXPECT_THAT(refused, GrpcStatusIs(grpc::StatusCode::ABORTED, HasSubstr("")));
    EXPECT_EQ(server::ReasonOf(refused), "WRITER_LEASE_HELD");
  }
  Wait(std::chrono::seconds(16));
  Recording other(journeys_.get(), kJourney, "another");
  EXPECT_EQ(other.Record(test::FlowAt(5)).next_sequence(), 6);
  EXPECT_THAT(other.Close(), IsGrpcOk());
  link_.CutAll();
}

TEST_F(LinkTest, AVerySlowClientDelaysNoOther) {
  link_.SetBytesPerSecond(20'000);
  std::thread crawling([&] {
    RobotOptions slow = robot_;
    slow.observations = 4;
    EXPECT_THAT(RecordOne(slow, "robots/slow/journeys/0", &ledger_), IsOk());
  });
  const std::string one = Undisturbed();
  EXPECT_TRUE(Undisturbed() == one);
  crawling.join();
}

// A client that sends requests and reads no answers blocks itself, and no other client.
TEST_F(LinkTest, AClientThatNeverReadsIsBlockedAndDelaysNoOther) {
  constexpr int kMost = 50'000;
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 20);
  grpc::ClientContext context;
  const auto stream = homing_->Localize(&context);
  std::atomic<int> written = 0;
  std::thread deaf([&] {
    v1::LocalizeRequest request;
    *request.mutable_config() = server::LocalizeOn(kJourney);
    bool open = stream->Write(request);
    while (open && written < kMost) {
      open = stream->Write(server::LocalizeRequestOf(test::FlowAt(written, written % 20)));
      ++written;
    }
  });
  // Until it is held back.
  for (int before = -1; before != written;) {
    before = written;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  EXPECT_LT(written, kMost) << "everything was taken though nothing was read";
  const std::string one = Undisturbed();
  EXPECT_TRUE(Undisturbed() == one);
  context.TryCancel();
  deaf.join();
}

TEST_F(LinkTest, RepeatedAndReorderedRequestsStoreNothingTwice) {
  for (int i = 0; i < 3; ++i) EXPECT_THAT(Create(), IsGrpcOk());
  {
    Recording recording(journeys_.get(), kJourney);
    for (const int sequence : {0, 1, 1, 2, 0, 3, 3, 2, 4}) {
      const auto answer = recording.Record(test::FlowAt(sequence));
      EXPECT_EQ(answer.sequence(), sequence);
    }
    recording.Send(test::FlowAt(6));
    EXPECT_THAT(recording.AwaitEnd(),
                GrpcStatusIs(grpc::StatusCode::OUT_OF_RANGE, HasSubstr("must be 5")));
  }
  Recording recording(journeys_.get(), kJourney);
  for (int i = 0; i < 8; ++i) recording.Record(test::FlowAt(i));
  EXPECT_THAT(recording.Close(), IsGrpcOk());
  for (int i = 0; i < 3; ++i) EXPECT_THAT(Finish(), IsGrpcOk());
  EXPECT_EQ(Get().step_count(), 8);
  EXPECT_EQ(Get().next_sequence(), 8);
}

TEST_F(LinkTest, ClientsCarryOnWhenTheServerDrainsAndComesBack) {
  robot_.observations = 150;
  robot_.pace = std::chrono::milliseconds(4);
  const std::string expected = Undisturbed();
  std::vector<std::thread> robots;
  for (int i = 0; i < 4; ++i) {
    robots.emplace_back([this, i] {
      const std::string journey = "robots/drained/journeys/" + std::to_string(i);
      EXPECT_THAT(RecordOne(robot_, journey, &ledger_), IsOk());
    });
  }
  for (int i = 0; i < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    StartServer();
    link_.SetUpstream(server_->address());
  }
  for (std::thread& robot : robots) robot.join();
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(Export("robots/drained/journeys/" + std::to_string(i)) == expected) << i;
  }
}

}  // namespace
}  // namespace homing::faults
