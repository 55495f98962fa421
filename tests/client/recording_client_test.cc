#include "client/recording_client.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <thread>

#include "tests/client/fake_journey_service.h"
#include "tests/client/numbered_stream.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

class RecordingClientTest : public ::testing::Test {
 protected:
  static Connection Connect(const std::string& address, int retry_ms = 20000) {
    ConnectionOptions options;
    options.address = address;
    options.retry_for = std::chrono::milliseconds(retry_ms);
    return *Connection::Open(options);
  }

  absl::StatusOr<RecordingSummary> Record(const Connection& connection, ObservationStream* stream,
                                          const std::stop_token& stop = {}) {
    RecordingOptions options;
    options.journey = "robots/a/journeys/b";
    options.writer_id = "writer";
    options.window = 8;
    options.keep = 4;
    RecordingClient client(&connection, options);
    return client.Record(
        stream,
        [this](const v1::RecordJourneyResponse& answer) {
          answered_.push_back(answer.sequence());
          return absl::OkStatus();
        },
        stop);
  }

  static std::vector<std::int64_t> Range(std::int64_t count) {
    std::vector<std::int64_t> range(static_cast<std::size_t>(count));
    std::iota(range.begin(), range.end(), 0);
    return range;
  }
  static std::vector<std::int64_t> Stored(const FakeJourneyService& service) {
    std::vector<std::int64_t> sequences;
    for (const auto& observation : service.stored()) sequences.push_back(observation.sequence());
    return sequences;
  }
  static int Breaks(const FakeJourneyService& service) {
    int breaks = 0;
    for (const auto& observation : service.stored()) breaks += observation.break_before() ? 1 : 0;
    return breaks;
  }

  std::vector<std::int64_t> answered_;
};

TEST_F(RecordingClientTest, StoresAllInOrderOverOneLink) {
  FakeJourneyService service({});
  FakeServer server(&service);
  NumberedStream stream(50);
  const auto summary = Record(Connect(server.address()), &stream);
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->next_sequence, 50);
  EXPECT_EQ(summary->reconnects, 0);
  EXPECT_EQ(Stored(service), Range(50));
  EXPECT_EQ(answered_, Range(50));
}

// The link breaks after every number of observations, with answers lost.
TEST_F(RecordingClientTest, StoresEachOnceWhereverTheLinkBreaks) {
  for (int cut = 0; cut <= 20; ++cut) {
    for (const int lost : {0, 1, 5}) {
      answered_.clear();
      Faults faults;
      faults.break_after_received = {cut};
      faults.unanswered_at_break = lost;
      FakeJourneyService service(faults);
      FakeServer server(&service);
      NumberedStream stream(20);
      const auto summary = Record(Connect(server.address()), &stream);
      ASSERT_THAT(summary, IsOk()) << "cut " << cut << " lost " << lost;
      EXPECT_EQ(Stored(service), Range(20)) << "cut " << cut << " lost " << lost;
      EXPECT_EQ(Breaks(service), 0) << "cut " << cut << " lost " << lost;
      EXPECT_EQ(summary->next_sequence, 20);
      EXPECT_TRUE(std::is_sorted(answered_.begin(), answered_.end()));
      EXPECT_EQ(std::adjacent_find(answered_.begin(), answered_.end()), answered_.end());
    }
  }
}

TEST_F(RecordingClientTest, ResumesAfterManyBrokenLinks) {
  Faults faults;
  faults.break_after_received = {3, 0, 1, 7, 0, 9, 2, 5};
  faults.unanswered_at_break = 2;
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(40);
  const auto summary = Record(Connect(server.address()), &stream);
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->reconnects, 8);
  EXPECT_EQ(Stored(service), Range(40));
}

TEST_F(RecordingClientTest, GetsThroughAProxyThatResetsAfterThreeObservations) {
  Faults faults;
  faults.proxy_resets_after = 3;
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(6);
  ASSERT_THAT(Record(Connect(server.address()), &stream), IsOk());
  EXPECT_EQ(Stored(service), Range(6));
  EXPECT_EQ(Breaks(service), 0);
}

TEST_F(RecordingClientTest, SendsTheReferenceAgainAfterABreak) {
  Faults faults;
  faults.break_after_received = {10};
  faults.look_back = 3;
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(12);
  ASSERT_THAT(Record(Connect(server.address()), &stream), IsOk());
  // Frames 8 and 9 may come again if their acknowledgements did not arrive before the break.
  std::vector<std::int64_t> received = service.received();
  ASSERT_GE(received.size(), 13U);
  EXPECT_EQ(received[10], 7);
  received.erase(received.begin() + 11, received.end() - 2);
  const std::vector<std::int64_t> expected = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 7, 10, 11};
  EXPECT_EQ(received, expected);
}

TEST_F(RecordingClientTest, ReportsDuplicatedAnswersOnce) {
  Faults faults;
  faults.duplicate_answers = true;
  faults.break_after_received = {6};
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(15);
  ASSERT_THAT(Record(Connect(server.address()), &stream), IsOk());
  EXPECT_EQ(Stored(service), Range(15));
  EXPECT_EQ(answered_, Range(15));
}

TEST_F(RecordingClientTest, LetsTheServerCorrectAGap) {
  Faults faults;
  faults.break_after_received = {4};
  faults.gap_links = 2;
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(12);
  ASSERT_THAT(Record(Connect(server.address()), &stream), IsOk());
  EXPECT_EQ(Stored(service), Range(12));
}

TEST_F(RecordingClientTest, GivesUpOnAGapThatStays) {
  Faults faults;
  faults.break_after_received = {4};
  faults.gap_links = 1000;
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(12);
  EXPECT_THAT(Record(Connect(server.address()), &stream),
              StatusIs(absl::StatusCode::kOutOfRange, HasSubstr("gap")));
}

// The same journey by a client that was restarted: it begins its source anew.
TEST_F(RecordingClientTest, ResumesWhereAnEarlierClientStopped) {
  Faults faults;
  faults.break_after_received = {9};
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream killed(9);
  const auto connection = Connect(server.address(), /*retry_ms=*/0);
  EXPECT_THAT(Record(connection, &killed), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("")));
  NumberedStream again(20);
  const auto summary = Record(connection, &again);
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->begun_at, 9);
  EXPECT_EQ(again.seeks(), std::vector<std::int64_t>{8});
  EXPECT_EQ(Stored(service), Range(20));
}

TEST_F(RecordingClientTest, ResumesWhenTheServerIsRestarted) {
  FakeJourneyService service({});
  auto server = std::make_unique<FakeServer>(&service);
  const int port = server->port();
  NumberedStream stream(5000);
  std::thread restart([&] {
    while (service.stored().size() < 100) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    server.reset();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    server = std::make_unique<FakeServer>(&service, port);
  });
  const auto summary = Record(Connect("127.0.0.1:" + std::to_string(port)), &stream);
  restart.join();
  ASSERT_THAT(summary, IsOk());
  EXPECT_GE(summary->reconnects, 1);
  EXPECT_EQ(Stored(service), Range(5000));
  EXPECT_TRUE(std::is_sorted(answered_.begin(), answered_.end()));
}

// However long the outage: the waits between two attempts stay short.
TEST_F(RecordingClientTest, IsBackSoonAfterTheServer) {
  using Clock = std::chrono::steady_clock;
  FakeJourneyService service({});
  auto server = std::make_unique<FakeServer>(&service);
  const int port = server->port();
  NumberedStream stream(1'000'000);
  std::stop_source stop;
  std::thread recording([&] {
    Record(Connect("127.0.0.1:" + std::to_string(port)), &stream, stop.get_token()).IgnoreError();
  });
  const auto await_more = [&](std::size_t than) {
    while (service.stored().size() <= than)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  await_more(100);
  server.reset();
  std::this_thread::sleep_for(std::chrono::seconds(4));
  const std::size_t before = service.stored().size();
  server = std::make_unique<FakeServer>(&service, port);
  const auto begin = Clock::now();
  await_more(before);
  EXPECT_LT(Clock::now() - begin, std::chrono::milliseconds(1500));
  stop.request_stop();
  recording.join();
}

TEST_F(RecordingClientTest, ALiveCameraMarksABreakWhenItResumes) {
  Faults faults;
  faults.break_after_received = {5};
  FakeJourneyService service(faults);
  FakeServer server(&service);
  const auto connection = Connect(server.address(), 0);
  NumberedStream killed(5, /*live=*/true);
  EXPECT_FALSE(Record(connection, &killed).ok());
  NumberedStream again(5, /*live=*/true);
  ASSERT_THAT(Record(connection, &again), IsOk());
  EXPECT_EQ(Stored(service), Range(10));
  EXPECT_EQ(Breaks(service), 1);
  EXPECT_TRUE(service.stored()[5].break_before());
}

TEST_F(RecordingClientTest, ALiveCameraResendsKeptObservationsWithoutABreak) {
  Faults faults;
  faults.break_after_received = {6};
  faults.unanswered_at_break = 3;
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(12, /*live=*/true);
  ASSERT_THAT(Record(Connect(server.address()), &stream), IsOk());
  EXPECT_EQ(Stored(service), Range(12));
  EXPECT_EQ(Breaks(service), 0);
}

TEST_F(RecordingClientTest, DoesNotRetryErrorsThatARetryCannotCure) {
  Faults faults;
  faults.refuse = grpc::Status(grpc::StatusCode::ABORTED, "another writer");
  FakeJourneyService service(faults);
  FakeServer server(&service);
  NumberedStream stream(5);
  EXPECT_THAT(Record(Connect(server.address()), &stream),
              StatusIs(absl::StatusCode::kAborted, "another writer"));
  EXPECT_EQ(service.links(), 1);
}

TEST_F(RecordingClientTest, StopsOnRequestAndKeepsDurableObservations) {
  FakeJourneyService service({});
  FakeServer server(&service);
  NumberedStream stream(1000000);
  std::stop_source stop;
  std::thread stopper([&] {
    while (service.stored().size() < 100) std::this_thread::yield();
    stop.request_stop();
  });
  EXPECT_THAT(Record(Connect(server.address()), &stream, stop.get_token()),
              StatusIs(absl::StatusCode::kCancelled, HasSubstr("")));
  stopper.join();
  EXPECT_LT(service.stored().size(), 1000000U);
}

TEST_F(RecordingClientTest, NamesTheAddressWhenItGivesUp) {
  NumberedStream stream(5);
  EXPECT_THAT(Record(Connect("127.0.0.1:1", 200), &stream),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("127.0.0.1:1")));
}

}  // namespace
}  // namespace homing::client
