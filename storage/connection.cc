#include "storage/connection.h"

#include <sqlite3.h>

#include <new>

#include "storage/sqlite_status.h"

namespace homing::storage {
namespace {

// Runs `body`; what SQLiteCpp throws becomes the status.
absl::Status Guard(const Connection::Body& body) {
  try {
    return body();
  } catch (const SQLite::Exception& exception) {
    return StatusFromException(exception);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("store: out of memory");
  }
}

}  // namespace

absl::StatusOr<std::unique_ptr<Connection>> Connection::Open(const std::string& path, Access access,
                                                             int busy_timeout_ms) {
  const int flags = SQLite::OPEN_NOMUTEX |
                    (access == Access::kReadOnly ? SQLite::OPEN_READONLY
                                                 : SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  std::unique_ptr<Connection> connection;
  absl::Status status = Guard([&] {
    connection.reset(new Connection(path, flags, busy_timeout_ms));
    connection->Execute("PRAGMA foreign_keys=ON");
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  return connection;
}

absl::Status Connection::Run(const Body& body) { return Guard(body); }

absl::Status Connection::Transact(const char* begin, const Body& body) {
  absl::Status status = Guard([&] {
    database_.exec(begin);
    absl::Status result = body();
    if (result.ok()) database_.exec("COMMIT");
    return result;
  });
  if (!status.ok()) RollBack();
  return status;
}

void Connection::RollBack() {
  // After some errors SQLite has rolled back by itself.
  if (sqlite3_get_autocommit(database_.getHandle()) == 0) database_.tryExec("ROLLBACK");
}

SQLite::Statement& Connection::Prepared(const char* sql) {
  std::unique_ptr<SQLite::Statement>& statement = statements_[sql];
  if (!statement) statement = std::make_unique<SQLite::Statement>(database_, sql);
  return *statement;
}

}  // namespace homing::storage
