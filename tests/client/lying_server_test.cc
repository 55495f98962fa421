// A server that answers what is not true, or ends a stream without an error.
#include <gtest/gtest.h>

#include <limits>

#include "client/homing_client.h"
#include "client/recording_client.h"
#include "tests/client/fake_journey_service.h"
#include "tests/client/numbered_stream.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;
using Number = std::numeric_limits<std::int64_t>;

constexpr std::int64_t kCount = 8;

class LyingServerTest : public ::testing::Test {
 protected:
  // The first links end after three observations, without an error.
  static Faults EndsEarly() {
    Faults faults;
    faults.break_after_received = {0, 3, 8};
    faults.breaks_silently = true;
    return faults;
  }
  Connection Connect(const FakeServer& server) const {
    ConnectionOptions options;
    options.address = server.address();
    options.retry_for = retry_for_;
    options.answer_time = answer_time_;
    return *Connection::Open(options);
  }
  absl::Status Record(const Faults& faults) {
    FakeJourneyService service(faults);
    const FakeServer server(&service);
    const Connection connection = Connect(server);
    RecordingClient client(&connection, {"robots/a/journeys/b", "writer"});
    NumberedStream stream(kCount);
    const auto summary = client.Record(&stream, [&](const v1::RecordJourneyResponse&) {
      ++answers_;
      return absl::OkStatus();
    });
    stored_ = static_cast<std::int64_t>(service.stored().size());
    return summary.status();
  }
  absl::Status Localize(const Faults& faults) {
    FakeJourneyService service(faults);
    const FakeServer server(&service);
    const Connection connection = Connect(server);
    HomingClient client(&connection);
    NumberedStream stream(kCount);
    return client.Localize({}, &stream, [&](const v1::LocalizeResponse&) {
      ++answers_;
      return absl::OkStatus();
    });
  }

  std::chrono::milliseconds retry_for_{300};
  std::chrono::milliseconds answer_time_{60000};
  std::int64_t stored_ = 0;
  int answers_ = 0;
};

TEST_F(LyingServerTest, AStreamThatEndsEarlyWithoutAnErrorIsALostLink) {
  EXPECT_THAT(Record(EndsEarly()), IsOk());
  EXPECT_EQ(stored_, kCount);
  answers_ = 0;
  EXPECT_THAT(Localize(EndsEarly()), IsOk());
  EXPECT_EQ(answers_, kCount);
}

TEST_F(LyingServerTest, AServerThatNeverAnswersIsALostLink) {
  answer_time_ = std::chrono::milliseconds(500);
  retry_for_ = std::chrono::seconds(30);
  Faults once;
  once.silent_links = 1;
  EXPECT_THAT(Record(once), IsOk());
  EXPECT_EQ(stored_, kCount);
  answers_ = 0;
  EXPECT_THAT(Localize(once), IsOk());
  EXPECT_EQ(answers_, kCount);
  Faults always;
  retry_for_ = std::chrono::milliseconds(300);
  always.silent_links = 1000;
  for (const absl::Status& status : {Record(always), Localize(always)}) {
    EXPECT_THAT(status, StatusIs(absl::StatusCode::kUnavailable, HasSubstr("did not answer")));
  }
}

TEST_F(LyingServerTest, WhatIsNotAcknowledgedIsNotRecorded) {
  Faults faults;
  faults.forgets = true;
  EXPECT_THAT(Record(faults),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("ended the stream early")));
}

TEST_F(LyingServerTest, AnsweringTheSameAgainIsNoAnswerToTheRest) {
  Faults faults;
  faults.lie_home = [](v1::LocalizeResponse* answer) { answer->set_sequence(0); };
  EXPECT_THAT(Localize(faults),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("ended the stream early")));
  EXPECT_EQ(answers_, 1);
}

TEST_F(LyingServerTest, NoAnswerToWhatWasNotSentIsBelieved) {
  for (const std::int64_t number : {kCount + 1, Number::max(), Number::min()}) {
    Faults next;
    next.lie = [&](v1::RecordJourneyResponse* answer) { answer->set_next_sequence(number); };
    Faults sequence;
    sequence.lie = [&](v1::RecordJourneyResponse* answer) { answer->set_sequence(number); };
    Faults home;
    home.lie_home = [&](v1::LocalizeResponse* answer) { answer->set_sequence(number); };
    for (const absl::Status& status : {Record(next), Record(sequence), Localize(home)}) {
      EXPECT_THAT(status, StatusIs(absl::StatusCode::kDataLoss, HasSubstr("were sent"))) << number;
    }
  }
  EXPECT_EQ(answers_, 0);
}

}  // namespace
}  // namespace homing::client
