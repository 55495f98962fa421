#include "server/catalog/writer_lease.h"

#include <chrono>

#include "server/base/error_reason.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

TEST(WriterLeaseTest, AnotherWriterWaitsFifteenSecondsFromTheLastSignOfLife) {
  WriterLease lease;
  const TimePoint start{};
  WriterLease::Evict previous;
  lease.Take("a", start, nullptr, &previous);
  EXPECT_THAT(lease.CheckFree("b", start + milliseconds(14'999)),
              StatusIs(absl::StatusCode::kAborted, HasSubstr("1 ms")));
  EXPECT_THAT(lease.CheckFree("b", start + seconds(15)), IsOk());
  lease.Renew(start + seconds(10));
  EXPECT_THAT(lease.CheckFree("b", start + seconds(15)),
              StatusIs(absl::StatusCode::kAborted, HasSubstr("another writer")));
  EXPECT_THAT(lease.CheckFree("b", start + seconds(25)), IsOk());
}

TEST(WriterLeaseTest, TheSameWriterTakesOverAtOnceAndTheOldClaimEnds) {
  WriterLease lease;
  const TimePoint start{};
  WriterLease::Evict previous;
  int evicted = 0;
  const auto first = lease.Take(
      "a", start, [&](const absl::Status&) { ++evicted; }, &previous);
  EXPECT_FALSE(previous);
  ASSERT_THAT(lease.CheckFree("a", start), IsOk());
  const auto second = lease.Take("a", start, nullptr, &previous);
  EXPECT_FALSE(lease.Holds(first));
  EXPECT_TRUE(lease.Holds(second));
  ASSERT_TRUE(previous);
  previous(absl::AbortedError("over"));
  EXPECT_EQ(evicted, 1);
}

TEST(WriterLeaseTest, AReleasedLeaseIsFreeForAnyone) {
  WriterLease lease;
  WriterLease::Evict previous;
  const auto claim = lease.Take("a", TimePoint{}, nullptr, &previous);
  lease.Release();
  EXPECT_FALSE(lease.Holds(claim));
  EXPECT_THAT(lease.CheckFree("b", TimePoint{}), IsOk());
}

TEST(WriterLeaseTest, TheRefusalSaysForProgramsHowLongTheLeaseLives) {
  WriterLease lease;
  WriterLease::Evict previous;
  lease.Take("a", TimePoint{}, nullptr, &previous);
  const ErrorReason reason = ReasonOf(lease.CheckFree("b", TimePoint{} + seconds(5)));
  EXPECT_EQ(reason.reason, "WRITER_LEASE_HELD");
  EXPECT_EQ(reason.metadata.at("lease_left_ms"), "10000");
}

TEST(WriterLeaseTest, AWriterIdIsPrintableAndShort) {
  EXPECT_THAT(CheckWriterId(std::string(128, 'w'), "writer_id"), IsOk());
  EXPECT_THAT(CheckWriterId(std::string(129, 'w'), "writer_id"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("at most 128")));
  EXPECT_THAT(CheckWriterId("a\nb", "writer_id"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("printable")));
}

}  // namespace
}  // namespace homing::server
