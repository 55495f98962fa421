// One connection to the SQLite file: transactions and prepared statements. Exceptions of SQLiteCpp
// are caught here.
#ifndef STORAGE_CONNECTION_H_
#define STORAGE_CONNECTION_H_

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::storage {

// Time to wait for a lock, ms, for programs beside the server.
inline constexpr int kBusyTimeoutMs = 5000;

// One use of a prepared statement; the destructor resets it. Its members throw SQLite::Exception,
// so that they may be used in the body of a transaction only. Not thread-safe.
class Query {
 public:
  explicit Query(SQLite::Statement* statement) : statement_(statement) {}
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;
  ~Query() { statement_->tryReset(); }

  // Steps to the next row; false: there is none.
  bool Next() { return statement_->executeStep(); }
  // Runs a statement without rows. Returns the number of rows changed.
  int Run() { return statement_->exec(); }
  // A value of another type, or NULL, is damage: SQLite would convert it to 0 or "".
  std::int64_t Integer(int column) { return Value(column, SQLite::INTEGER).getInt64(); }
  double Real(int column) { return Value(column, SQLite::FLOAT).getDouble(); }
  std::string Text(int column) { return Value(column, SQLite::TEXT).getString(); }
  // A BLOB, unchanged.
  std::string Bytes(int column) {
    const SQLite::Column value = Value(column, SQLite::BLOB);
    return {static_cast<const char*>(value.getBlob()), static_cast<std::size_t>(value.getBytes())};
  }
  bool IsNull(int column) { return statement_->isColumnNull(column); }
  // All are NULL until they are bound.
  void ClearValues() { statement_->clearBindings(); }
  // Value `index`, from 1.
  template <typename Value>
  void Bind(int index, Value value) {
    statement_->bind(index, value);
  }
  // Value `index`, from 1, is a BLOB.
  void BindBytes(int index, const std::string& bytes) {
    statement_->bind(index, bytes.data(), static_cast<int>(bytes.size()));
  }

 private:
  SQLite::Column Value(int column, int type);

  SQLite::Statement* statement_;
};

// Not thread-safe.
class Connection {
 public:
  using Body = std::function<absl::Status()>;

  // kImmutable: read-only, and no other program changes the file: no lock, no log, no other file.
  enum class Access { kReadWrite, kReadOnly, kImmutable };
  static absl::StatusOr<std::unique_ptr<Connection>> Open(const std::string& path, Access access,
                                                          int busy_timeout_ms);

  // Commits if `body` returns OK, else rolls back. An exception of SQLiteCpp rolls back and becomes
  // the status. Write takes the write lock at once. Read sees one state of the store from its first
  // query to its end.
  absl::Status Write(const Body& body) { return Transact("BEGIN IMMEDIATE", body); }
  absl::Status Read(const Body& body) { return Transact("BEGIN", body); }
  // Runs `body` without a transaction (PRAGMA); exceptions become the status.
  absl::Status Run(const Body& body);

  // Call it in a body. `sql` must be a literal: its address is the key of the prepared statement.
  template <typename... Values>
  Query Prepare(const char* sql, const Values&... values) {
    SQLite::Statement& statement = Prepared(sql);
    if constexpr (sizeof...(values) > 0) SQLite::bind(statement, values...);
    return Query(&statement);
  }
  // Call it in a body. Runs any number of statements without results.
  void Execute(const std::string& sql) { database_.exec(sql); }
  // Call it in a body. The first value of one row.
  std::int64_t Integer(const std::string& sql) { return database_.execAndGet(sql).getInt64(); }
  std::string Text(const std::string& sql) { return database_.execAndGet(sql).getString(); }

  // Rows changed since it was opened.
  int changes() const { return database_.getTotalChanges(); }
  SQLite::Database& database() { return database_; }

 private:
  Connection(const std::string& path, int flags, int busy_timeout_ms)
      : database_(path, flags, busy_timeout_ms) {}
  absl::Status Transact(const char* begin, const Body& body);
  void RollBack();
  SQLite::Statement& Prepared(const char* sql);

  SQLite::Database database_;
  std::unordered_map<const char*, std::unique_ptr<SQLite::Statement>> statements_;
};

// `path` has a log with pages that are not in the file yet: it is in use, or was not closed
// cleanly.
bool HasLog(const std::string& path);

// Opens a file that a server may be using, for reading: as kReadOnly, but as kImmutable if it has
// no log, so that no other file is created.
absl::StatusOr<std::unique_ptr<Connection>> OpenForReading(const std::string& path,
                                                           int busy_timeout_ms);

}  // namespace homing::storage

#endif  // STORAGE_CONNECTION_H_
