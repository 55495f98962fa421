#include "client/robot/observation_file.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::robot {
namespace {

// Runs `work`, which may throw: no exception leaves this file.
template <typename Work>
absl::Status Guarded(const SQLite::Database& database, const Work& work) {
  try {
    work();
    return absl::OkStatus();
  } catch (const SQLite::Exception& error) {
    return absl::UnavailableError(
        absl::StrCat("buffer file ", database.getFilename(), ": ", error.what()));
  }
}

std::int64_t Number(SQLite::Database& database, const char* query) {
  return database.execAndGet(query).getInt64();
}

void Prepare(SQLite::Database& database) {
  // Another program would send the same observations.
  database.exec("PRAGMA locking_mode = EXCLUSIVE");
  database.exec("PRAGMA journal_mode = WAL");
  database.exec("PRAGMA synchronous = NORMAL");
  database.exec(
      "CREATE TABLE IF NOT EXISTS observation "
      "(sequence INTEGER PRIMARY KEY, message BLOB NOT NULL)");
  database.exec("CREATE TABLE IF NOT EXISTS buffer (journey TEXT NOT NULL)");
}

}  // namespace

ObservationFile::ObservationFile(std::unique_ptr<SQLite::Database> database)
    : database_(std::move(database)) {}
ObservationFile::ObservationFile(ObservationFile&&) noexcept = default;
ObservationFile& ObservationFile::operator=(ObservationFile&&) noexcept = default;
ObservationFile::~ObservationFile() = default;

absl::StatusOr<ObservationFile> ObservationFile::Open(const std::string& path,
                                                      const std::string& journey) {
  std::unique_ptr<SQLite::Database> database;
  std::string held;
  try {
    database =
        std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    Prepare(*database);
    SQLite::Transaction change(*database);
    if (Number(*database, "SELECT count(*) FROM observation") > 0) {
      held = database->execAndGet("SELECT journey FROM buffer").getString();
    } else {
      database->exec("DELETE FROM buffer");
      SQLite::Statement insert(*database, "INSERT INTO buffer VALUES (?)");
      insert.bind(1, journey);
      insert.exec();
    }
    change.commit();
  } catch (const SQLite::Exception& error) {
    const std::string text = absl::StrCat("buffer file ", path, ": ", error.what());
    return error.getErrorCode() == SQLITE_BUSY
               ? absl::FailedPreconditionError(text + "; another program uses it")
               : absl::UnavailableError(text);
  }
  if (!held.empty() && held != journey) {
    return absl::FailedPreconditionError(
        absl::StrCat("buffer file ", path, " holds observations of ", held, ", not of ", journey));
  }
  return ObservationFile(std::move(database));
}

absl::Status ObservationFile::Append(std::span<const StoredObservation> observations) {
  return Guarded(*database_, [&] {
    SQLite::Transaction change(*database_);
    SQLite::Statement insert(*database_, "INSERT OR REPLACE INTO observation VALUES (?, ?)");
    for (const StoredObservation& observation : observations) {
      insert.bind(1, observation.sequence);
      insert.bindNoCopy(2, observation.bytes.data(), static_cast<int>(observation.bytes.size()));
      insert.exec();
      insert.reset();
    }
    change.commit();
  });
}

absl::StatusOr<std::optional<StoredObservation>> ObservationFile::Read(
    std::int64_t sequence) const {
  std::optional<StoredObservation> found;
  HOMING_RETURN_IF_ERROR(Guarded(*database_, [&] {
    SQLite::Statement query(*database_,
                            "SELECT sequence, message FROM observation WHERE sequence >= ? "
                            "ORDER BY sequence LIMIT 1");
    query.bind(1, sequence);
    if (!query.executeStep()) return;
    found = StoredObservation{query.getColumn(0).getInt64(), query.getColumn(1).getString()};
  }));
  return found;
}

absl::StatusOr<std::int64_t> ObservationFile::DropBefore(std::int64_t sequence, std::int64_t kept) {
  std::int64_t bytes = 0;
  HOMING_RETURN_IF_ERROR(Guarded(*database_, [&] {
    SQLite::Transaction change(*database_);
    SQLite::Statement size(*database_,
                           "SELECT ifnull(sum(length(message)), 0) FROM observation "
                           "WHERE sequence < ? AND sequence <> ?");
    SQLite::Statement erase(*database_,
                            "DELETE FROM observation WHERE sequence < ? AND sequence <> ?");
    for (SQLite::Statement* statement : {&size, &erase}) {
      statement->bind(1, sequence);
      statement->bind(2, kept);
    }
    size.executeStep();
    bytes = size.getColumn(0).getInt64();
    size.reset();
    erase.exec();
    change.commit();
  }));
  return bytes;
}

absl::Status ObservationFile::Renumber(std::int64_t first, std::int64_t shift) {
  return Guarded(*database_, [&] {
    SQLite::Transaction change(*database_);
    // Uses negative numbers in between, since no two rows may have the same number at any time.
    SQLite::Statement move(
        *database_, "UPDATE observation SET sequence = -1 - sequence - ? WHERE sequence >= ?");
    move.bind(1, shift);
    move.bind(2, first);
    move.exec();
    database_->exec("UPDATE observation SET sequence = -1 - sequence WHERE sequence < 0");
    change.commit();
  });
}

absl::StatusOr<ObservationFile::Extent> ObservationFile::Measure() const {
  Extent extent;
  HOMING_RETURN_IF_ERROR(Guarded(*database_, [&] {
    extent.end = Number(*database_, "SELECT ifnull(max(sequence) + 1, 0) FROM observation");
    extent.count = Number(*database_, "SELECT count(*) FROM observation");
    extent.bytes = Number(*database_, "SELECT ifnull(sum(length(message)), 0) FROM observation");
  }));
  return extent;
}

}  // namespace homing::robot
