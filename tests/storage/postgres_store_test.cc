// What many servers on one PostgreSQL rely on: leases, fencing, doubt, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <thread>

#include "absl/strings/str_cat.h"
#include "storage/postgres/pg_connection.h"
#include "storage/postgres/pg_step_rows.h"
#include "tests/storage/postgres_fixture.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(PostgresStoreTest, TheSameWriterTakesOverAtOnceAndTheOldServerWritesNothing) {
  const std::vector<JourneyStep> steps = MakeSteps(3);
  const std::int64_t old = one_->AcquireJourney(kJourney, "robot#a").value().epoch;
  ASSERT_THAT(one_->AppendSteps({Append(steps[0], old)})[0], IsOk());
  const auto acquired = two_->AcquireJourney(kJourney, "robot#b");
  ASSERT_THAT(acquired, IsOk());
  EXPECT_EQ(acquired->record.next_sequence, 1);
  EXPECT_EQ(acquired->record.writer_id, "robot#b");
  EXPECT_THAT(one_->AppendSteps({Append(steps[1], old)})[0],
              StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  EXPECT_EQ(two_->GetJourney(kJourney)->next_sequence, 1);
  EXPECT_THAT(two_->AppendSteps({Append(steps[1], acquired->epoch)})[0], IsOk());
  EXPECT_THAT(one_->AppendSteps({Append(steps[2], old)})[0],
              StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  EXPECT_TRUE(SameMap(*one_->LoadMap(kJourney), MapOf(OddSettings(), {steps[0], steps[1]})));
}

TEST_F(PostgresStoreTest, AnotherWriterWaitsForTheLeaseOfAServerThatIsAlive) {
  ASSERT_THAT(one_->AcquireJourney(kJourney, "robot"), IsOk());
  const auto held = StatusIs(absl::StatusCode::kAborted, HasSubstr("lease"));
  EXPECT_THAT(two_->AcquireJourney(kJourney, "other"), held);
  EXPECT_THAT(two_->CheckLease(kJourney, "other"), held);
  EXPECT_THAT(two_->CheckLease(kJourney, "robot#2"), IsOk());
  EXPECT_THAT(one_->AcquireJourney(kJourney, "other"), IsOk());
  EXPECT_THAT(two_->AcquireJourney(kJourney, "robot"), held);
  KillHeartbeats();
  EXPECT_THAT(two_->AcquireJourney(kJourney, "robot"), IsOk());
}

// The replica that was promoted has a clock behind that of the primary before it.
TEST_F(PostgresStoreTest, TimesInTheFutureHoldNoLease) {
  ASSERT_THAT(one_->AcquireJourney(kJourney, "robot"), IsOk());
  ASSERT_THAT(Query("UPDATE servers SET beat_at = now() + interval '1 h'"), IsEmpty());
  ASSERT_THAT(Query("UPDATE journeys SET written_at = now() + interval '1 h'"), IsEmpty());
  EXPECT_THAT(two_->AcquireJourney(kJourney, "other"), IsOk());
}

TEST_F(PostgresStoreTest, ASilentWriterLosesTheLeaseAlthoughItsServerIsAlive) {
  ASSERT_THAT(one_->AcquireJourney(kJourney, "robot"), IsOk());
  ASSERT_THAT(Query("UPDATE journeys SET written_at = now() - interval '16 s'"), IsEmpty());
  EXPECT_THAT(two_->AcquireJourney(kJourney, "other"), IsOk());
}

TEST_F(PostgresStoreTest, AServerThatStopsFreesItsJourneys) {
  ASSERT_THAT(one_->AcquireJourney(kJourney, "robot"), IsOk());
  one_.reset();
  EXPECT_THAT(two_->AcquireJourney(kJourney, "other"), IsOk());
}

TEST_F(PostgresStoreTest, OneBatchStoresTheJourneysThatFitAndExplainsTheOthers) {
  const std::vector<JourneyStep> steps = MakeSteps(2);
  const std::string taken = "robots/r/journeys/taken";
  const std::string finished = "robots/r/journeys/finished";
  for (const std::string& name : {taken, finished}) {
    ASSERT_THAT(one_->CreateJourney(Record(name)), IsOk());
  }
  std::vector<JourneyAppend> batch;
  for (const std::string& name : {std::string(kJourney), taken, finished}) {
    JourneyAppend append = AppendOf(name, steps[0]);
    append.epoch = one_->AcquireJourney(name, "robot").value().epoch;
    ASSERT_THAT(one_->AppendSteps({append})[0], IsOk());
    append.sequence = 1;
    append.step = steps[1];
    batch.push_back(append);
  }
  // Behind the back of the rows that the first server keeps.
  ASSERT_THAT(two_->AcquireJourney(taken, "robot"), IsOk());
  ASSERT_THAT(two_->FinishJourney(finished), IsOk());
  const std::vector<absl::Status> statuses = one_->AppendSteps(batch);
  EXPECT_THAT(statuses[0], IsOk());
  EXPECT_THAT(statuses[1], StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  EXPECT_THAT(statuses[2], StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finished")));
  EXPECT_EQ(Query("SELECT count(*) FROM steps"), "4\n");
}

TEST_F(PostgresStoreTest, ACommitWhoseAnswerIsLostIsDecidedByReading) {
  const std::vector<JourneyStep> steps = MakeSteps(60);
  const std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  std::atomic<bool> stop = false;
  std::thread killer([&] {
    while (!stop) {
      Query(
          "SELECT pg_terminate_backend(pid) FROM pg_stat_activity"
          " WHERE pid <> pg_backend_pid() AND datname = current_database()");
    }
  });
  for (const JourneyStep& step : steps) {
    EXPECT_THAT(one_->AppendSteps({Append(step, epoch)})[0], IsOk());
  }
  stop = true;
  killer.join();
  EXPECT_TRUE(SameMap(*two_->LoadMap(kJourney), MapOf(OddSettings(), steps)));
}

TEST_F(PostgresStoreTest, ACrashOfTheDatabaseLosesNothingThatWasAcknowledged) {
  const std::vector<JourneyStep> steps = MakeSteps(40);
  std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  std::thread crash([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    server_->Crash();
    server_->Start();
  });
  for (std::size_t next = 0; next < steps.size();) {
    const absl::Status status = one_->AppendSteps({Append(steps[next], epoch)})[0];
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    next += status.ok() ? 1 : 0;
    if (status.ok()) continue;
    // The database was away for too long: as a robot that comes back.
    ASSERT_THAT(status, StatusIs(absl::StatusCode::kUnavailable, HasSubstr("store")));
    const auto acquired = one_->AcquireJourney(kJourney, "robot");
    if (!acquired.ok()) continue;
    epoch = acquired->epoch;
    ASSERT_GE(acquired->record.next_sequence, static_cast<std::int64_t>(next));
    next = static_cast<std::size_t>(acquired->record.next_sequence);
  }
  crash.join();
  EXPECT_TRUE(SameMap(*one_->LoadMap(kJourney), MapOf(OddSettings(), steps)));
}

// PostgreSQL then reports success, with a warning. It takes up the setting some time after it was
// made: steps are appended until one waits.
TEST_F(PostgresStoreTest, ACommitThatGivesUpWaitingForItsReplicaIsNotAcknowledged) {
  const std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  const auto set_replica = [&](const std::string& name) {
    Query("ALTER SYSTEM SET synchronous_standby_names = '" + name + "'");
    Query("SELECT pg_reload_conf()");
  };
  std::atomic<bool> is_done = false;
  std::atomic<int> acknowledged = 0;
  absl::Status status;
  std::thread append([&] {
    for (const JourneyStep& step : MakeSteps(500)) {
      status = one_->AppendSteps({Append(step, epoch)})[0];
      if (!status.ok() || is_done) break;
      ++acknowledged;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  set_replica("nobody");
  int cancelled = 0;
  int before = 0;
  for (int i = 0; i < 200 && cancelled < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::string rows =
        Query("SELECT pg_cancel_backend(pid) FROM pg_stat_activity WHERE wait_event = 'SyncRep'");
    if (rows.empty()) continue;
    if (cancelled++ == 0) before = acknowledged;
  }
  EXPECT_EQ(cancelled, 2);
  EXPECT_EQ(acknowledged, before);
  is_done = true;
  set_replica("");
  append.join();
  EXPECT_THAT(status, IsOk());
  EXPECT_EQ(two_->GetJourney(kJourney)->next_sequence, before + 1);
}

TEST_F(PostgresStoreTest, ADatabaseThatDoesNotAnswerIsUnavailableInTime) {
  const std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  server_->Crash();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(one_->AppendSteps({Append(MakeSteps(1)[0], epoch)})[0],
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("store")));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
  EXPECT_FALSE(one_->WriteHealth().ok());
  server_->Start();
  EXPECT_THAT(one_->ProbeWrite(), IsOk());
  EXPECT_THAT(one_->AppendSteps({Append(MakeSteps(1)[0], epoch)})[0], IsOk());
}

TEST_F(PostgresStoreTest, OtherJourneysBeginWhileAnAppendWaits) {
  const std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  const auto soon = postgres::After(std::chrono::seconds(10));
  const auto locking =
      postgres::PgConnection::Open(url_, postgres::PgConnection::Access::kReadWrite);
  ASSERT_THAT(locking.value()->Execute("BEGIN; SELECT 1 FROM journeys FOR UPDATE", soon), IsOk());
  std::atomic<bool> is_appended = false;
  std::thread append(
      [&] { is_appended = one_->AppendSteps({Append(MakeSteps(1)[0], epoch)})[0].ok(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_THAT(one_->CreateJourney(Record("robots/r/journeys/other")), IsOk());
  EXPECT_THAT(one_->AcquireJourney("robots/r/journeys/other", "robot"), IsOk());
  EXPECT_FALSE(is_appended);
  EXPECT_THAT((*locking)->Execute("COMMIT", soon), IsOk());
  append.join();
  EXPECT_TRUE(is_appended);
}

TEST_F(PostgresStoreTest, CommitsThatAreNotSynchronousAreRefused) {
  for (const char* setting : {"off", "local"}) {
    Query("ALTER DATABASE " + database_ + " SET synchronous_commit = " + setting);
    EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kFailedPrecondition,
                                 HasSubstr(std::string("synchronous_commit is ") + setting)));
  }
}

TEST_F(PostgresStoreTest, ANewerSchemaIsRefusedAndManyServersMayMigrateAtOnce) {
  Query("UPDATE homing_schema SET version = 99");
  EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("99, newer")));
  url_ = server_->NewDatabase();
  std::vector<std::thread> servers;
  for (int i = 0; i < 4; ++i) {
    servers.emplace_back([this] { EXPECT_THAT(Open(), IsOk()); });
  }
  for (std::thread& server : servers) server.join();
}

TEST_F(PostgresStoreTest, PlainSqlReadsTheValuesToTheBit) {
  std::vector<JourneyStep> steps = MakeSteps(5);
  steps[0].fingerprints[0].fingerprint.x = -0.1F;
  steps[0].fingerprints[0].spread = 1e-310;
  const std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  for (const JourneyStep& step : steps) {
    ASSERT_THAT(one_->AppendSteps({Append(step, epoch)})[0], IsOk());
  }
  std::string expected;
  for (const JourneyStep& step : steps) {
    for (const RecordedFingerprint& f : step.fingerprints) {
      expected += absl::StrCat(step.step, "|", f.side == Side::kLeft ? "LEFT" : "RIGHT", "|",
                               f.fingerprint.landmark, "|", f.fingerprint.count, "|t|t\n");
    }
  }
  std::string values;
  for (const JourneyStep& step : steps) {
    for (const RecordedFingerprint& f : step.fingerprints) {
      char text[96];
      std::snprintf(text, sizeof text, "%s(%lld, %d, %.17g::float8, %.17g::float8)",
                    values.empty() ? "" : ", ", static_cast<long long>(step.step),
                    f.fingerprint.landmark, double{f.fingerprint.x}, f.spread);
      values += text;
    }
  }
  EXPECT_EQ(Query("SELECT f.step, side, f.landmark, count, f.x = v.x, f.spread = v.spread"
                  " FROM journey_fingerprints f JOIN (VALUES " +
                  values +
                  ") AS v(step, landmark, x, spread) ON v.step = f.step"
                  " AND v.landmark = f.landmark ORDER BY f.step, side, f.x"),
            expected);
  EXPECT_EQ(Query("SELECT count(*) FROM journey_landmarks WHERE journey = '" +
                  std::string(kJourney) + "'"),
            absl::StrCat(one_->GetJourney(kJourney)->landmark_count, "\n"));
}

TEST(PgFingerprints, OtherBytesAreDamage) {
  EXPECT_THAT(postgres::DecodeFingerprints("x"),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("1 bytes")));
}

}  // namespace
}  // namespace homing::storage
