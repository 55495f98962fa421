#include "server/base/trace_scope.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace homing::server {
namespace {

constexpr char kTrace[] = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";

TEST(TraceParentTest, ReadsWhatItWrites) {
  const auto trace = ParseTraceParent(kTrace);
  ASSERT_TRUE(trace.has_value());
  EXPECT_EQ(trace->trace_id, "4bf92f3577b34da6a3ce929d0e0e4736");
  EXPECT_EQ(trace->span_id, "00f067aa0ba902b7");
  EXPECT_TRUE(IsSampled(*trace));
  EXPECT_EQ(ToString(*trace), kTrace);
}

TEST(TraceParentTest, TheLastBitOfTheFlagsIsSampled) {
  for (const char* flags : {"00", "02", "a8"}) {
    EXPECT_FALSE(IsSampled({"", "", flags})) << flags;
  }
  EXPECT_TRUE(IsSampled({"", "", "0f"}));
}

TEST(TraceParentTest, RefusesOtherForms) {
  const std::string good = kTrace;
  const std::vector<std::string> wrong = {
      "",
      good.substr(1),
      good + "0",
      good + "-00",
      "ff" + good.substr(2),
      "00-" + std::string(32, '0') + good.substr(35),
      good.substr(0, 36) + std::string(16, '0') + "-01",
      good.substr(0, 54) + "\n",
      "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01"};
  for (const std::string& text : wrong) {
    EXPECT_FALSE(ParseTraceParent(text).has_value()) << text;
  }
  EXPECT_TRUE(ParseTraceParent("01" + good.substr(2) + "-later").has_value());
}

TEST(TraceScopeTest, NestsAndBelongsToItsThread) {
  const TraceParent outer{"a", "b"};
  const TraceParent inner{"c", "d"};
  EXPECT_EQ(TraceScope::Current(), nullptr);
  {
    const TraceScope scope(&outer);
    {
      const TraceScope nested(&inner);
      EXPECT_EQ(TraceScope::Current(), &inner);
    }
    EXPECT_EQ(TraceScope::Current(), &outer);
    std::jthread([] { EXPECT_EQ(TraceScope::Current(), nullptr); });
  }
  EXPECT_EQ(TraceScope::Current(), nullptr);
}

}  // namespace
}  // namespace homing::server
