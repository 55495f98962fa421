// The quota of one robot, and the age limit.
#include "server/admission/journey_quota.h"

#include "server/base/error_reason.h"
#include "tests/server/session/session_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class JourneyQuotaTest : public SessionTest {
 protected:
  static std::string Name(const std::string& id) { return "robots/r/journeys/" + id; }
  void Make(const std::string& id, std::int64_t create_time_ns, bool finished) {
    storage::JourneyRecord record;
    record.name = Name(id);
    record.writer_id = "writer";
    record.create_time_ns = create_time_ns;
    ASSERT_THAT(catalog_->Create(record), IsOk());
    if (finished) {
      ASSERT_THAT(catalog_->Finish(record.name, "writer", false, {}), IsOk());
    }
  }
  void ReopenReadOnly() {
    queue_.reset();
    catalog_.reset();
    store_.reset();
    storage::StoreOptions options;
    options.url = folder_.Database();
    options.read_only = true;
    store_ = storage::OpenJourneyStore(options).value();
    catalog_ = std::make_unique<JourneyCatalog>(store_.get());
  }
  bool IsThere(const std::string& id) { return catalog_->Get(Name(id)).ok(); }
  Limits limits_;
};

TEST_F(JourneyQuotaTest, AtTheLimitANewJourneyIsRefusedAndOneThatIsThereIsNot) {
  limits_.max_robot_journeys = 2;
  JourneyQuota quota(catalog_.get(), limits_);
  Make("a", 1, true);
  ASSERT_THAT(quota.CheckNew(Name("b")), IsOk());
  Make("b", 2, false);
  const absl::Status refused = quota.CheckNew(Name("c"));
  EXPECT_THAT(refused,
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("max-robot-journeys is 2")));
  EXPECT_EQ(ReasonOf(refused).reason, "ROBOT_JOURNEYS");
  EXPECT_THAT(quota.CheckNew(Name("b")), IsOk());
  EXPECT_THAT(quota.CheckNew("robots/other/journeys/c"), IsOk());
  EXPECT_TRUE(IsThere("a"));
}

TEST_F(JourneyQuotaTest, WithDeleteOldestTheOldestFinishedOneIsDeleted) {
  limits_.max_robot_journeys = 3;
  limits_.delete_oldest = true;
  JourneyQuota quota(catalog_.get(), limits_);
  Make("b", 1, false);
  Make("c", 3, true);
  Make("d", 2, true);
  ASSERT_THAT(quota.CheckNew(Name("e")), IsOk());
  EXPECT_FALSE(IsThere("d"));
  EXPECT_TRUE(IsThere("b"));
  EXPECT_TRUE(IsThere("c"));
  EXPECT_EQ(quota.deleted(), 1);
}

TEST_F(JourneyQuotaTest, NothingIsDeletedIfThatMakesNoRoom) {
  Make("big", 2, false);
  RecordFlow(0, 10, Name("big"));
  Make("small", 1, true);
  limits_.max_robot_bytes = QuotaBytes(catalog_->Get(Name("big")).value());
  limits_.delete_oldest = true;
  JourneyQuota quota(catalog_.get(), limits_);
  EXPECT_EQ(ReasonOf(quota.CheckNew(Name("more"))).reason, "ROBOT_BYTES");
  EXPECT_TRUE(IsThere("small"));
}

TEST_F(JourneyQuotaTest, JourneysBeingRecordedAreNeverDeleted) {
  limits_.max_robot_journeys = 1;
  limits_.delete_oldest = true;
  limits_.delete_after_s = 1;
  JourneyQuota quota(catalog_.get(), limits_);
  Make("a", 1, false);
  EXPECT_THAT(quota.CheckNew(Name("b")),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("1 journeys")));
  EXPECT_EQ(quota.DeleteExpired(1'000'000'000'000, 0).value(), 0);
  EXPECT_TRUE(IsThere("a"));
}

TEST_F(JourneyQuotaTest, BytesAreThoseOfFingerprintsAndProfiles) {
  Make("out", 1, false);
  RecordFlow(0, 10, Name("out"));
  const std::int64_t bytes = QuotaBytes(catalog_->Get(Name("out")).value());
  EXPECT_GE(bytes, 10 * 2 * 128);
  limits_.max_robot_bytes = bytes + 1;
  EXPECT_THAT(JourneyQuota(catalog_.get(), limits_).CheckGrowth(Name("out")), IsOk());
  limits_.max_robot_bytes = bytes;
  JourneyQuota full(catalog_.get(), limits_);
  EXPECT_EQ(ReasonOf(full.CheckGrowth(Name("out"))).reason, "ROBOT_BYTES");
  EXPECT_EQ(ReasonOf(full.CheckNew(Name("more"))).reason, "ROBOT_BYTES");
}

TEST_F(JourneyQuotaTest, WithDeleteAfterOldFinishedJourneysAreDeleted) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  Make("old", 10 * kSecond, true);
  Make("new", 20 * kSecond, true);
  EXPECT_EQ(JourneyQuota(catalog_.get(), limits_).DeleteExpired(100 * kSecond, 0).value(), 0);
  limits_.delete_after_s = 5;
  JourneyQuota quota(catalog_.get(), limits_);
  EXPECT_EQ(quota.DeleteExpired(15 * kSecond, 0).value(), 0);
  EXPECT_EQ(quota.DeleteExpired(16 * kSecond, 11 * kSecond).value(), 0);
  EXPECT_EQ(quota.DeleteExpired(16 * kSecond, 0).value(), 1);
  EXPECT_FALSE(IsThere("old"));
  EXPECT_TRUE(IsThere("new"));
}

TEST_F(JourneyQuotaTest, OfAReadOnlyStoreNothingIsDeletedAndNothingFails) {
  Make("old", 1, true);
  ReopenReadOnly();
  limits_.delete_after_s = 1;
  JourneyQuota quota(catalog_.get(), limits_);
  EXPECT_THAT(quota.DeleteExpired(1'000'000'000'000, 0), IsOk());
  EXPECT_TRUE(IsThere("old"));
}

}  // namespace
}  // namespace homing::server
