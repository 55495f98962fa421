#include "storage/sqlite_status.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

TEST(StatusFromSqlite, TheCodeShowsTheCallersAction) {
  const std::pair<int, absl::StatusCode> codes[] = {
      {SQLITE_BUSY, absl::StatusCode::kUnavailable},
      {SQLITE_BUSY_SNAPSHOT, absl::StatusCode::kUnavailable},
      {SQLITE_LOCKED, absl::StatusCode::kUnavailable},
      {SQLITE_CONSTRAINT_UNIQUE, absl::StatusCode::kAlreadyExists},
      {SQLITE_CONSTRAINT_PRIMARYKEY, absl::StatusCode::kAlreadyExists},
      {SQLITE_CONSTRAINT_CHECK, absl::StatusCode::kInvalidArgument},
      {SQLITE_CONSTRAINT_FOREIGNKEY, absl::StatusCode::kInternal},
      {SQLITE_CORRUPT, absl::StatusCode::kDataLoss},
      {SQLITE_CORRUPT_INDEX, absl::StatusCode::kDataLoss},
      {SQLITE_NOTADB, absl::StatusCode::kDataLoss},
      {SQLITE_FULL, absl::StatusCode::kResourceExhausted},
      {SQLITE_READONLY, absl::StatusCode::kFailedPrecondition},
      {SQLITE_READONLY_DBMOVED, absl::StatusCode::kFailedPrecondition},
      {SQLITE_CANTOPEN, absl::StatusCode::kFailedPrecondition},
      {SQLITE_IOERR_FSYNC, absl::StatusCode::kUnavailable},
      {SQLITE_IOERR_READ, absl::StatusCode::kUnavailable},
      {SQLITE_IOERR_SHMSIZE, absl::StatusCode::kResourceExhausted},
      {SQLITE_IOERR_CORRUPTFS, absl::StatusCode::kUnavailable},
      {SQLITE_IOERR_DATA, absl::StatusCode::kDataLoss},
      {SQLITE_MISUSE, absl::StatusCode::kInternal}};
  for (const auto& [code, expected] : codes) {
    EXPECT_THAT(StatusFromSqlite(code, "what happened"),
                StatusIs(expected, ::testing::HasSubstr("what happened")))
        << code;
  }
}

TEST(StatusFromSqlite, DistinguishesFaultsOfTheStoreFromRefusals) {
  for (const int fault : {SQLITE_FULL, SQLITE_IOERR_WRITE, SQLITE_READONLY, SQLITE_BUSY}) {
    EXPECT_TRUE(IsStoreFault(StatusFromSqlite(fault, ""))) << fault;
  }
  EXPECT_FALSE(IsStoreFault(StatusFromSqlite(SQLITE_CONSTRAINT_UNIQUE, "")));
  EXPECT_FALSE(IsStoreFault(absl::ResourceExhaustedError("too many requests")));
  EXPECT_FALSE(IsStoreFault(absl::OkStatus()));
}

}  // namespace
}  // namespace homing::storage
