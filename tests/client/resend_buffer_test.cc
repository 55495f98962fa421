#include "client/resend_buffer.h"

#include <gtest/gtest.h>

#include "tests/client/numbered_stream.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

std::int64_t NextSequence(ResendBuffer& buffer) {
  const auto next = buffer.Next();
  return next.ok() && *next != nullptr ? (*next)->sequence() : -1;
}

void Send(ResendBuffer& buffer, int count) {
  for (int i = 0; i < count; ++i) ASSERT_GE(NextSequence(buffer), 0);
}

TEST(ResendBufferTest, SendsAgainFromTheBufferWithoutSeeking) {
  NumberedStream stream(20);
  ResendBuffer buffer(&stream, 3);
  Send(buffer, 10);
  buffer.Acknowledge(6);
  ASSERT_THAT(buffer.Rewind(4, 6), IsOk());
  EXPECT_EQ(NextSequence(buffer), 4);
  Send(buffer, 5);
  EXPECT_EQ(NextSequence(buffer), 10);
  EXPECT_TRUE(stream.seeks().empty());
}

TEST(ResendBufferTest, SeeksWhenTheBufferDoesNotGoBackFarEnough) {
  NumberedStream stream(20);
  ResendBuffer buffer(&stream, 3);
  Send(buffer, 10);
  buffer.Acknowledge(10);
  ASSERT_THAT(buffer.Rewind(2, 3), IsOk());
  EXPECT_EQ(NextSequence(buffer), 2);
  EXPECT_EQ(stream.seeks(), std::vector<std::int64_t>{2});
}

TEST(ResendBufferTest, ALiveStreamIsMarkedWhereTheKeptOnesBegin) {
  NumberedStream stream(20, /*live=*/true);
  ResendBuffer buffer(&stream, 2);
  Send(buffer, 10);
  buffer.Acknowledge(8);
  ASSERT_THAT(buffer.Rewind(4, 8), IsOk());
  const auto next = buffer.Next();
  ASSERT_THAT(next, IsOk());
  EXPECT_EQ((*next)->sequence(), 8);
  EXPECT_TRUE((*next)->break_before());
}

TEST(ResendBufferTest, ALiveStreamThatLostTheExpectedObservationReportsIt) {
  NumberedStream stream(20, /*live=*/true);
  ResendBuffer buffer(&stream, 2);
  Send(buffer, 10);
  buffer.Acknowledge(8);
  EXPECT_THAT(buffer.Rewind(0, 1),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("needs observation 1")));
}

TEST(ResendBufferTest, KeepsTheReferenceAndDropsThoseBetween) {
  NumberedStream stream(200, /*live=*/true);
  ResendBuffer buffer(&stream, 0);
  Send(buffer, 100);
  buffer.Acknowledge(90, 7);
  ASSERT_THAT(buffer.Rewind(7, 90), IsOk());
  EXPECT_EQ(NextSequence(buffer), 7);
  EXPECT_EQ(NextSequence(buffer), 90);
  Send(buffer, 9);
  EXPECT_EQ(NextSequence(buffer), 100);
  EXPECT_TRUE(stream.seeks().empty());
}

// The acknowledgement of a later reference was lost.
TEST(ResendBufferTest, GoesOnFromAReferenceThatItHasNotHeardOf) {
  NumberedStream stream(200, /*live=*/true);
  ResendBuffer buffer(&stream, 0);
  Send(buffer, 100);
  buffer.Acknowledge(90, 7);
  buffer.Acknowledge(98, 95);
  ASSERT_THAT(buffer.Rewind(95, 98), IsOk());
  EXPECT_EQ(NextSequence(buffer), 95);
  EXPECT_EQ(NextSequence(buffer), 98);
}

TEST(ResendBufferTest, WhatIsBeingSentAgainIsNotDropped) {
  NumberedStream stream(200, /*live=*/true);
  ResendBuffer buffer(&stream, 0);
  Send(buffer, 10);
  buffer.Acknowledge(4, 3);
  ASSERT_THAT(buffer.Rewind(3, 4), IsOk());
  EXPECT_EQ(NextSequence(buffer), 3);
  buffer.Acknowledge(8, 3);
  EXPECT_EQ(NextSequence(buffer), 4);
}

TEST(ResendBufferTest, KeepsNoMoreThanConfigured) {
  NumberedStream stream(1000);
  ResendBuffer buffer(&stream, 4);
  Send(buffer, 1000);
  buffer.Acknowledge(1000);
  EXPECT_EQ(buffer.RewindTo(0), 996);
}

}  // namespace
}  // namespace homing::client
