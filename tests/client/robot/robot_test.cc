// The installed classes against a server in this process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "homing/client/localizer.h"
#include "homing/client/recorder.h"
#include "server/homing_server.h"
#include "tests/support/route.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::robot {
namespace {

using std::chrono::seconds;

constexpr char kJourney[] = "robots/r/journeys/out";

View ViewOf(const FlowField& field) {
  Flow flow{field.width, field.height, {}};
  for (const homing::FlowVector& vector : field.vectors) {
    flow.vectors.push_back({vector.start_x, vector.start_y, vector.end_x, vector.end_y});
  }
  return View{std::nullopt, flow};
}

Observation FlowAt(int place) {
  Observation observation;
  observation.left = ViewOf(test::FieldAt(place, homing::Side::kLeft));
  observation.right = ViewOf(test::FieldAt(place, homing::Side::kRight));
  return observation;
}

class RobotTest : public ::testing::Test {
 protected:
  RobotTest() { StartServer(); }

  void StartServer() {
    server::ServerOptions options;
    options.listen = address_;
    options.database = folder_.Database();
    auto server = server::HomingServer::Start(options);
    ASSERT_THAT(server.status(), IsOk());
    server_ = *std::move(server);
    address_ = server_->address();
  }

  std::unique_ptr<Recorder> Record(const std::string& writer = "writer",
                                   const std::string& journey = kJourney) {
    RecorderOptions options;
    options.journey = journey;
    options.writer = writer;
    options.buffer_file = folder_.File("buffer");
    options.memory_observations = 4;
    options.on_recorded = [this](const Recorded& recorded) {
      EXPECT_EQ(recorded.sequence, durable_++);
      if (recorded.step) ++steps_;
    };
    options.on_message = [this](const std::string& text) { messages_ += text + "\n"; };
    auto recorder = Recorder::Open(Server{address_}, options);
    EXPECT_TRUE(recorder.ok()) << recorder.status().message();
    return *std::move(recorder);
  }

  static void Add(Recorder& recorder, int first, int end) {
    for (int place = first; place < end; ++place) {
      const Status added = recorder.Add(FlowAt(place));
      EXPECT_TRUE(added.ok()) << added.message();
    }
  }

  void AwaitDurable(int count) const {
    while (durable_ < count) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  static void ExpectDone(Recorder& recorder) {
    const Status done = recorder.Finish(seconds(30));
    EXPECT_TRUE(done.ok()) << done.message();
  }

  TemporaryFolder folder_;
  std::string address_ = "127.0.0.1:0";
  std::unique_ptr<server::HomingServer> server_;
  std::atomic<int> durable_ = 0;
  std::atomic<int> steps_ = 0;
  // Written by the thread of the one recorder.
  std::string messages_;
};

TEST_F(RobotTest, RecordsAndLocalises) {
  {
    const auto recorder = Record();
    Add(*recorder, 0, 60);
    ExpectDone(*recorder);
    EXPECT_EQ(recorder->pending(), 0);
    EXPECT_EQ(durable_, 60);
    EXPECT_EQ(recorder->Add(FlowAt(0)).code(), Code::kFailedPrecondition);
  }
  LocalizerOptions options;
  options.journey = kJourney;
  options.travel = Travel::kSame;
  auto localizer = Localizer::Open(Server{address_}, options);
  ASSERT_TRUE(localizer.ok()) << localizer.status().message();
  Answer last;
  for (int place = 10; place < 40; ++place) {
    const auto answer = (*localizer)->Localize(FlowAt(place), seconds(10));
    ASSERT_TRUE(answer.ok()) << answer.status().message();
    EXPECT_EQ(answer->sequence, place - 10);
    last = *answer;
  }
  EXPECT_EQ(last.outcome, Outcome::kMatch);
  EXPECT_EQ(last.journey, kJourney);
  ASSERT_TRUE(last.step);
  EXPECT_NEAR(static_cast<double>(*last.step), 39, 2);
  EXPECT_GE(last.on_route, last.probability);
  ASSERT_TRUE(last.speed_ratio);
  EXPECT_GT(*last.speed_ratio, 0);
  EXPECT_FALSE(last.matches.empty());
}

TEST_F(RobotTest, WhatIsSeenWhileTheLinkIsDownIsRecordedLater) {
  const auto recorder = Record();
  Add(*recorder, 0, 10);
  server_.reset();
  Add(*recorder, 10, 30);
  EXPECT_EQ(recorder->Finish(std::chrono::milliseconds(50)).code(), Code::kDeadlineExceeded);
  EXPECT_GE(recorder->pending(), 20);
  StartServer();
  ExpectDone(*recorder);
  EXPECT_EQ(durable_, 30);
}

TEST_F(RobotTest, WhatWaitsSurvivesTheProgram) {
  server_.reset();
  {
    const auto recorder = Record();
    Add(*recorder, 0, 20);
  }
  StartServer();
  const auto recorder = Record();
  EXPECT_EQ(recorder->pending(), 20);
  Add(*recorder, 20, 25);
  ExpectDone(*recorder);
  EXPECT_EQ(durable_, 25);
}

TEST_F(RobotTest, AfterTheServerWasRestoredFromABackupWhatWaitsIsRecordedBehindAGap) {
  {
    const auto recorder = Record();
    Add(*recorder, 0, 10);
    AwaitDurable(10);
  }
  server_.reset();
  std::filesystem::copy_file(folder_.File("homing.db"), folder_.File("backup"));
  StartServer();
  {
    const auto recorder = Record();
    Add(*recorder, 10, 20);
    AwaitDurable(20);
    server_.reset();
    Add(*recorder, 20, 30);
  }
  std::filesystem::rename(folder_.File("backup"), folder_.File("homing.db"));
  StartServer();
  durable_ = 10;
  const auto recorder = Record();
  Add(*recorder, 30, 35);
  ExpectDone(*recorder);
  EXPECT_GE(durable_, 25);
  EXPECT_LE(durable_, 26) << "the reference may be sent again";
  EXPECT_THAT(messages_, ::testing::HasSubstr("only the first 10 observations"));
}

TEST_F(RobotTest, TheFileOfAFinishedJourneyCanBeUsedForAnother) {
  for (const char* journey : {"robots/r/journeys/a", "robots/r/journeys/b"}) {
    durable_ = 0;
    const auto recorder = Record("writer", journey);
    Add(*recorder, 0, 20);
    ExpectDone(*recorder);
  }
}

TEST_F(RobotTest, AFinishedJourneyIsNotRecordedAgain) {
  {
    const auto recorder = Record();
    Add(*recorder, 0, 3);
    ExpectDone(*recorder);
  }
  const auto again = Record();
  const Status done = again->Finish(seconds(10));
  EXPECT_EQ(done.code(), Code::kAlreadyExists) << done.message();
  EXPECT_EQ(again->Add(FlowAt(3)).code(), Code::kAlreadyExists);
}

TEST_F(RobotTest, WrongOptionsAreNamed) {
  RecorderOptions options;
  options.journey = "out";
  options.writer = "writer";
  EXPECT_THAT(Recorder::Open(Server{address_}, options).status().message(),
              ::testing::HasSubstr("robots/ROBOT/journeys/JOURNEY"));
  options.journey = kJourney;
  options.writer = "";
  EXPECT_EQ(Recorder::Open(Server{address_}, options).status().code(), Code::kInvalidArgument);
  EXPECT_EQ(Recorder::Open(Server{"no port"}, options).status().code(), Code::kInvalidArgument);
}

TEST_F(RobotTest, TheJourneyMayBeRecordedAfterTheLocalizerIsOpened) {
  LocalizerOptions options;
  options.journey = kJourney;
  options.travel = Travel::kSame;
  auto localizer = Localizer::Open(Server{address_}, options);
  ASSERT_TRUE(localizer.ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto recorder = Record();
  Add(*recorder, 0, 20);
  ExpectDone(*recorder);
  const auto answer = (*localizer)->Localize(FlowAt(3), seconds(10));
  EXPECT_TRUE(answer.ok()) << answer.status().message();
}

TEST_F(RobotTest, NoAnswerInTime) {
  LocalizerOptions options;
  options.journey = kJourney;
  server_.reset();
  auto localizer = Localizer::Open(Server{address_}, options);
  ASSERT_TRUE(localizer.ok());
  EXPECT_EQ((*localizer)->Localize(FlowAt(0), std::chrono::milliseconds(20)).status().code(),
            Code::kDeadlineExceeded);
}

}  // namespace
}  // namespace homing::robot
