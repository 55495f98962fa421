#include "client/server_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "client/connection.h"
#include "client/recording_client.h"
#include "client/server_address.h"
#include "tests/client/fake_journey_service.h"
#include "tests/client/numbered_stream.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ServerListTest, IsSplitAtCommas) {
  EXPECT_THAT(ServersOf("a:1"), ElementsAre("a:1"));
  EXPECT_THAT(ServersOf("a:1,[::1]:2"), ElementsAre("a:1", "[::1]:2"));
  EXPECT_THAT(ServersOf("dns:///a:1"), ElementsAre("a:1"));
  EXPECT_FALSE(MayBeMany("a:1"));
  EXPECT_TRUE(MayBeMany("dns:///a:1"));
}

TEST(ServerListTest, EachServerMustBeAnAddress) {
  EXPECT_THAT(CheckServerAddress("dns:///base:50551"), IsOk());
  EXPECT_THAT(CheckServerAddress("a:1,b:2"), IsOk());
  for (const char* bad : {"a:1,", "a:1,b", "a:1,,b:2", "dns:///", "dns:///a"}) {
    EXPECT_THAT(CheckServerAddress(bad),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("HOST:PORT")))
        << bad;
  }
}

TEST(ServerListTest, BecomesNumbersOfOneFamily) {
  EXPECT_EQ(*ChannelTarget("base:1"), "base:1");
  EXPECT_EQ(*ChannelTarget("dns:///base:1"), "dns:///base:1");
  EXPECT_EQ(*ChannelTarget("127.0.0.1:1,10.0.0.2:3"), "ipv4:127.0.0.1:1,10.0.0.2:3");
  EXPECT_EQ(*ChannelTarget("[::1]:1,[fd00::2]:3"), "ipv6:[::1]:1,[fd00::2]:3");
  EXPECT_THAT(ChannelTarget("127.0.0.1:1,[::1]:1"),
              StatusIs(absl::StatusCode::kUnavailable,
                       HasSubstr("must all have an IPv4 address, or all an IPv6 address")));
}

// A camera at 50 Hz.
class PacedStream final : public NumberedStream {
 public:
  using NumberedStream::NumberedStream;
  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return NumberedStream::Next();
  }
};

TEST(ServerListTest, ARecordingGoesOnWithAnotherServerInUnderTwoSeconds) {
  using Clock = std::chrono::steady_clock;
  FakeJourneyService service({});
  auto one = std::make_unique<FakeServer>(&service);
  const int port = std::make_unique<FakeServer>(&service)->port();
  ConnectionOptions options;
  options.address = one->address() + ",127.0.0.1:" + std::to_string(port);
  const auto connection = Connection::Open(options);
  ASSERT_THAT(connection, IsOk());
  PacedStream stream(200);
  RecordingOptions recording;
  recording.journey = "robots/a/journeys/b";
  recording.writer_id = "writer";
  RecordingClient client(&*connection, recording);
  // Only the first server answers when the stream begins.
  std::unique_ptr<FakeServer> two;
  Clock::time_point last = Clock::now();
  Clock::duration longest{};
  std::atomic<bool> is_over = false;
  std::thread events([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    two = std::make_unique<FakeServer>(&service, port);
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    one.reset();
    is_over = true;
  });
  const auto summary = client.Record(&stream, [&](const v1::RecordJourneyResponse&) {
    longest = std::max(longest, Clock::now() - std::exchange(last, Clock::now()));
    return absl::OkStatus();
  });
  events.join();
  ASSERT_THAT(summary, IsOk());
  EXPECT_TRUE(is_over);
  EXPECT_EQ(summary->next_sequence, 200);
  EXPECT_EQ(summary->reconnects, 1);
  EXPECT_LT(longest, std::chrono::seconds(2));
}

}  // namespace
}  // namespace homing::client
