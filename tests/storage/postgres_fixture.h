// Two stores on one new database, as two servers on it.
#ifndef TESTS_STORAGE_POSTGRES_FIXTURE_H_
#define TESTS_STORAGE_POSTGRES_FIXTURE_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/storage/store_fixture.h"
#include "tests/support/postgres_server.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {

class PostgresStoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    server_ = test::PostgresServer::Shared(&reason);
    if (server_ == nullptr) GTEST_SKIP() << "SKIPPED: " << reason;
    url_ = server_->NewDatabase();
    database_ = url_.substr(url_.find("@/") + 2);
    database_ = database_.substr(0, database_.find('?'));
    one_ = OpenOrDie(url_);
    two_ = OpenOrDie(url_);
    ASSERT_THAT(one_->CreateJourney(Record(kJourney)), IsOk());
  }

  std::string Query(const std::string& sql) { return server_->Query(database_, sql); }
  // As a server that has not shown itself for 20 s.
  void KillHeartbeats() {
    ASSERT_THAT(Query("UPDATE servers SET beat_at = now() - interval '20 s'"),
                ::testing::IsEmpty());
  }
  static JourneyAppend Append(const JourneyStep& step, std::int64_t epoch) {
    JourneyAppend append = AppendOf(kJourney, step);
    append.epoch = epoch;
    return append;
  }
  absl::StatusOr<std::unique_ptr<JourneyStore>> Open() {
    StoreOptions options;
    options.url = url_;
    return OpenJourneyStore(options);
  }

  test::PostgresServer* server_ = nullptr;
  std::string url_;
  std::string database_;
  std::unique_ptr<JourneyStore> one_;
  std::unique_ptr<JourneyStore> two_;
};

}  // namespace homing::storage

#endif  // TESTS_STORAGE_POSTGRES_FIXTURE_H_
