#include "storage/postgres/pg_connection.h"

#include <poll.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "homing/base/status_macros.h"
#include "storage/postgres/pg_status.h"

namespace homing::storage::postgres {
namespace {

constexpr int kBinary = 1;
// Longest time for one of the hosts to answer, s: a machine that is cut off never answers. libpq
// accepts no smaller value.
constexpr char kHostSeconds[] = "2";

std::string Trimmed(const char* message) {
  return std::string(absl::StripAsciiWhitespace(message == nullptr ? "" : message));
}

// Waits for `events` of a socket. False: the deadline has passed.
bool AwaitSocket(int socket, short events, Deadline deadline) {
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd waiting{socket, events, 0};
    const int ready =
        ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 60'000)));
    if (ready > 0 || (ready < 0 && errno != EINTR)) return true;
  }
}

}  // namespace

std::int64_t PgRows::changed() const { return std::atoll(PQcmdTuples(result_.get())); }

std::int64_t PgRows::Integer(int row, int column) const {
  if (PQgetlength(result_.get(), row, column) != 8) return 0;
  return static_cast<std::int64_t>(ReadBigEndian(PQgetvalue(result_.get(), row, column), 8));
}

double PgRows::Real(int row, int column) const {
  return std::bit_cast<double>(Integer(row, column));
}

std::string PgRows::Text(int row, int column) const {
  return {PQgetvalue(result_.get(), row, column),
          static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}

std::vector<PgHost> HostsOf(const std::string& url) {
  std::map<std::string, std::vector<std::string>> lists;
  PQconninfoOption* const options = PQconninfoParse(url.c_str(), nullptr);
  for (const PQconninfoOption* each = options; each != nullptr && each->keyword != nullptr;
       ++each) {
    if (each->val != nullptr) lists[each->keyword] = absl::StrSplit(each->val, ',');
  }
  PQconninfoFree(options);
  // One port may serve all hosts.
  const auto part = [&lists](const char* keyword, std::size_t i) -> std::string {
    const std::vector<std::string>& list = lists[keyword];
    return list.empty() ? "" : list[std::min(i, list.size() - 1)];
  };
  std::vector<PgHost> hosts;
  for (std::size_t i = 0; i < std::max(lists["host"].size(), lists["hostaddr"].size()); ++i) {
    hosts.push_back({part("host", i), part("hostaddr", i), part("port", i)});
  }
  return hosts;
}

absl::StatusOr<std::unique_ptr<PgConnection>> PgConnection::Open(
    const std::string& url, Access access, const std::optional<PgHost>& host) {
  // The parameters before dbname are defaults, which the URL may override. libpq would print
  // warnings of a role's or database's settings, so they are not sent.
  std::vector<const char*> names = {"application_name", "target_session_attrs", "connect_timeout",
                                    "options", "dbname"};
  std::vector<const char*> values = {"homing-server",
                                     access == Access::kReadWrite ? "read-write" : "any",
                                     kHostSeconds, "-c client_min_messages=error", url.c_str()};
  if (host) {
    names.insert(names.end(), {"host", "hostaddr", "port"});
    values.insert(values.end(), {host->host.c_str(), host->hostaddr.c_str(), host->port.c_str()});
  }
  names.push_back(nullptr);
  values.push_back(nullptr);
  // A blocking call: only this one limits the time of each host, and then tries the next host.
  std::unique_ptr<PgConnection> connection(
      new PgConnection(PQconnectdbParams(names.data(), values.data(), /*expand_dbname=*/1)));
  PGconn* const opened = connection->connection_;
  if (opened == nullptr) return absl::ResourceExhaustedError("store: out of memory");
  if (PQstatus(opened) != CONNECTION_OK) {
    return StatusOfConnection(Trimmed(PQerrorMessage(opened)));
  }
  PQsetNoticeReceiver(opened, &NoteWarning, connection.get());
  PQsetnonblocking(opened, 1);
  return connection;
}

PgConnection::~PgConnection() { PQfinish(connection_); }

void PgConnection::NoteWarning(void* connection, const PGresult* notice) {
  const char* const severity = PQresultErrorField(notice, PG_DIAG_SEVERITY_NONLOCALIZED);
  if (severity != nullptr && std::strcmp(severity, "WARNING") == 0) {
    static_cast<PgConnection*>(connection)->warned_ = true;
  }
}

absl::Status PgConnection::Lost(const std::string& why) {
  in_doubt_ = true;
  return absl::UnavailableError(absl::StrCat("store: ", why));
}

absl::Status PgConnection::AwaitResult(Deadline deadline) {
  while (true) {
    const int unsent = PQflush(connection_);
    if (unsent < 0) return Lost(Trimmed(PQerrorMessage(connection_)));
    if (unsent == 0 && PQisBusy(connection_) == 0) return absl::OkStatus();
    const short events = static_cast<short>(unsent > 0 ? POLLIN | POLLOUT : POLLIN);
    if (!AwaitSocket(PQsocket(connection_), events, deadline)) {
      return Lost("the database did not answer in time");
    }
    if (PQconsumeInput(connection_) == 0) return Lost(Trimmed(PQerrorMessage(connection_)));
  }
}

absl::StatusOr<PgRows> PgConnection::TakeResults(Deadline deadline) {
  PgRows rows(nullptr);
  absl::Status error;
  while (true) {
    HOMING_RETURN_IF_ERROR(AwaitResult(deadline));
    PGresult* const result = PQgetResult(connection_);
    if (result == nullptr) break;
    PgRows taken(result);
    const ExecStatusType status = PQresultStatus(result);
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) {
      if (error.ok()) error = StatusOfResult(result);
      // The server ends the connection, perhaps after it has committed.
      if (IsFatal(result)) in_doubt_ = true;
    }
    rows = std::move(taken);
  }
  if (PQstatus(connection_) != CONNECTION_OK) in_doubt_ = true;
  HOMING_RETURN_IF_ERROR(error);
  if (warned_) return Lost("the commit was not confirmed by the replica");
  return rows;
}

absl::Status PgConnection::Prepare(const char* sql, const PgArguments& arguments,
                                   Deadline deadline) {
  const std::string name = absl::StrCat("s", prepared_.size());
  const std::vector<Oid> types(arguments.types().begin(), arguments.types().end());
  if (PQsendPrepare(connection_, name.c_str(), sql, arguments.size(), types.data()) == 0) {
    return Lost(Trimmed(PQerrorMessage(connection_)));
  }
  HOMING_RETURN_IF_ERROR(TakeResults(deadline).status());
  prepared_[sql] = name;
  return absl::OkStatus();
}

absl::StatusOr<PgRows> PgConnection::Run(const char* sql, const PgArguments& arguments,
                                         Deadline deadline) {
  if (!prepared_.contains(sql)) HOMING_RETURN_IF_ERROR(Prepare(sql, arguments, deadline));
  std::vector<const char*> values;
  std::vector<int> lengths;
  for (const std::string& value : arguments.values()) {
    values.push_back(value.data());
    lengths.push_back(static_cast<int>(value.size()));
  }
  const std::vector<int> formats(values.size(), kBinary);
  if (PQsendQueryPrepared(connection_, prepared_[sql].c_str(), arguments.size(), values.data(),
                          lengths.data(), formats.data(), kBinary) == 0) {
    return Lost(Trimmed(PQerrorMessage(connection_)));
  }
  return TakeResults(deadline);
}

absl::Status PgConnection::Execute(const std::string& sql, Deadline deadline) {
  if (PQsendQuery(connection_, sql.c_str()) == 0) {
    return Lost(Trimmed(PQerrorMessage(connection_)));
  }
  return TakeResults(deadline).status();
}

}  // namespace homing::storage::postgres
