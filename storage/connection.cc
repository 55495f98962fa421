#include "storage/connection.h"

#include <sqlite3.h>

#include <filesystem>
#include <new>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "storage/sqlite_status.h"

namespace homing::storage {
namespace {

int FlagsOf(Connection::Access access) {
  switch (access) {
    case Connection::Access::kReadOnly:
      return SQLite::OPEN_READONLY;
    case Connection::Access::kImmutable:
      return SQLite::OPEN_READONLY | SQLite::OPEN_URI;
    case Connection::Access::kReadWrite:
      break;
  }
  return SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE;
}

// As a URI, with its special characters escaped.
std::string ImmutableUri(const std::string& path) {
  std::string uri = absl::StartsWith(path, "/") ? "file://" : "file:";
  for (const char c : path) {
    const bool plain = c != '%' && c != '?' && c != '#' && c >= ' ' && c <= '~';
    uri += plain ? std::string(1, c)
                 : absl::StrFormat("%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return uri + "?immutable=1";
}

// Runs `body`; exceptions of SQLiteCpp become the status.
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

SQLite::Column Query::Value(int column, int type) {
  SQLite::Column value = statement_->getColumn(column);
  const int found = value.getType();
  if (found != type && !(type == SQLite::FLOAT && found == SQLite::INTEGER)) {
    throw SQLite::Exception(std::string("column ") + value.getName() + " holds " +
                                (found == SQLite::Null ? "NULL" : "a value of another type"),
                            SQLITE_CORRUPT);
  }
  return value;
}

absl::StatusOr<std::unique_ptr<Connection>> Connection::Open(const std::string& path, Access access,
                                                             int busy_timeout_ms) {
  // SQLite's memory statistics are not used, and take a lock at each allocation. This must run
  // before the first use; later SQLite refuses it, without harm.
  static const int uncounted = sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
  static_cast<void>(uncounted);
  const int flags = SQLite::OPEN_NOMUTEX | FlagsOf(access);
  const std::string file = access == Access::kImmutable ? ImmutableUri(path) : path;
  std::unique_ptr<Connection> connection;
  absl::Status status = Guard([&] {
    connection.reset(new Connection(file, flags, busy_timeout_ms));
    connection->Execute("PRAGMA foreign_keys=ON");
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  return connection;
}

absl::Status Connection::Run(const Body& body) { return Guard(body); }

absl::Status Connection::Transact(const char* begin, const Body& body) {
  try {
    absl::Status status = Guard([&] {
      database_.exec(begin);
      absl::Status result = body();
      if (result.ok()) database_.exec("COMMIT");
      return result;
    });
    if (!status.ok()) RollBack();
    return status;
  } catch (...) {
    // Out of memory, for example.
    RollBack();
    throw;
  }
}

void Connection::RollBack() {
  // SQLite has already rolled back after some errors.
  if (sqlite3_get_autocommit(database_.getHandle()) == 0) database_.tryExec("ROLLBACK");
}

SQLite::Statement& Connection::Prepared(const char* sql) {
  std::unique_ptr<SQLite::Statement>& statement = statements_[sql];
  if (!statement) statement = std::make_unique<SQLite::Statement>(database_, sql);
  return *statement;
}

bool HasLog(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path + "-wal", error);
  return !error && size > 0;
}

absl::StatusOr<std::unique_ptr<Connection>> OpenForReading(const std::string& path,
                                                           int busy_timeout_ms) {
  std::error_code error;
  const bool used = std::filesystem::exists(path + "-wal", error);
  return Connection::Open(
      path, used ? Connection::Access::kReadOnly : Connection::Access::kImmutable, busy_timeout_ms);
}

}  // namespace homing::storage
