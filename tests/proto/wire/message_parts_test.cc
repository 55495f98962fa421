#include "proto/wire/message_parts.h"

#include <gmock/gmock.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <string>

#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"

namespace homing::wire {
namespace {

using ::testing::Optional;

template <typename Message>
std::optional<int> Count(const std::string& bytes, int most = 100) {
  google::protobuf::io::ArrayInputStream stream(bytes.data(), static_cast<int>(bytes.size()));
  return CountParts(*Message::descriptor(), &stream, most);
}

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(CountParts, MessagesAndRepeatedTexts) {
  v1::MatchLandmarksRequest request;
  request.set_journey("robots/r/journeys/j");
  for (int i = 0; i < 5; ++i) {
    request.mutable_left()->mutable_fingerprints()->add_fingerprints()->set_x(1);
  }
  // Two messages around the fingerprints.
  EXPECT_THAT(Count<v1::MatchLandmarksRequest>(request.SerializeAsString()), Optional(7));
  v1::SetReadersRequest readers;
  readers.set_name("robots/r/journeys/j");
  readers.add_readers("*");
  readers.add_readers("");
  EXPECT_THAT(Count<v1::SetReadersRequest>(readers.SerializeAsString()), Optional(2));
  EXPECT_THAT(Count<v1::SetReadersRequest>(""), Optional(0));
}

TEST(CountParts, VectorsAreNoParts) {
  v1::FlowVectors vectors;
  for (int i = 0; i < 1000; ++i) vectors.add_start_x(1);
  EXPECT_THAT(Count<v1::FlowVectors>(vectors.SerializeAsString()), Optional(0));
}

TEST(CountParts, UnknownFieldsAndThoseOfAnotherType) {
  EXPECT_THAT(Count<v1::GetJourneyRequest>(Repeated(std::string("\x78\x00", 2), 50)), Optional(50));
  // The name is a text.
  EXPECT_THAT(Count<v1::GetJourneyRequest>(Repeated(std::string("\x08\x00", 2), 50)), Optional(50));
}

TEST(CountParts, EndsAtTheMost) {
  EXPECT_THAT(Count<v1::SetReadersRequest>(Repeated(std::string("\x12\x00", 2), 50'000)),
              Optional(101));
}

TEST(CountParts, NoMessage) {
  const std::string group = "\x7b\x7c";
  const std::string cut(
      "\x12\x05"
      "ab",
      4);
  const std::string huge = "\x12\xff\xff\xff\xff\x0f";
  for (const std::string& bytes : {group, cut, huge, std::string("\xff")}) {
    EXPECT_EQ(Count<v1::SetReadersRequest>(bytes), std::nullopt);
    EXPECT_EQ(Count<v1::MatchLandmarksRequest>("\x1a\x04" + bytes), std::nullopt);
  }
}

}  // namespace
}  // namespace homing::wire
