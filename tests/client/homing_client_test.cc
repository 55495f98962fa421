#include "client/homing_client.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/client/fake_journey_service.h"
#include "tests/client/numbered_stream.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

std::vector<std::int64_t> Localize(const Faults& faults, std::int64_t count, absl::Status* status,
                                   int* links) {
  FakeJourneyService service(faults);
  FakeServer server(&service);
  ConnectionOptions connection_options;
  connection_options.address = server.address();
  const auto connection = Connection::Open(connection_options);
  HomingClient client(&*connection);
  NumberedStream stream(count);
  LocalizingOptions options;
  options.window = 8;
  options.replay = 5;
  std::vector<std::int64_t> answered;
  *status = client.Localize(options, &stream, [&](const v1::LocalizeResponse& answer) {
    answered.push_back(answer.sequence());
    return absl::OkStatus();
  });
  *links = service.links();
  return answered;
}

TEST(HomingClientTest, AnswersEachObservationOnceInOrder) {
  absl::Status status;
  int links = 0;
  const auto answered = Localize({}, 30, &status, &links);
  EXPECT_THAT(status, IsOk());
  ASSERT_EQ(answered.size(), 30U);
  EXPECT_EQ(answered.front(), 0);
  EXPECT_EQ(answered.back(), 29);
}

TEST(HomingClientTest, ReplaysTheLastStepsAfterABrokenLink) {
  std::vector<std::int64_t> expected(30);
  std::iota(expected.begin(), expected.end(), 0);
  for (int cut = 0; cut < 30; ++cut) {
    Faults faults;
    faults.break_after_received = {cut, 7};
    absl::Status status;
    int links = 0;
    const auto answered = Localize(faults, 30, &status, &links);
    EXPECT_THAT(status, IsOk()) << cut;
    EXPECT_EQ(answered, expected) << cut;
    EXPECT_GE(links, 2) << cut;
  }
}

// It cannot send the last five answered ones again: they would fill the link.
TEST(HomingClientTest, GetsThroughAProxyThatResetsAfterThreeObservations) {
  Faults faults;
  faults.proxy_resets_after = 3;
  absl::Status status;
  int links = 0;
  std::vector<std::int64_t> expected(8);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(Localize(faults, 8, &status, &links), expected);
  EXPECT_THAT(status, IsOk());
}

}  // namespace
}  // namespace homing::client
