#include "tests/support/postgres_server.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"

namespace homing::test {
namespace {

constexpr char kPrograms[] = "/usr/lib/postgresql/15/bin/";

// The output of a shell command; "FAILED" and the output if its status is not 0.
std::string RunShell(const std::string& command) {
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return "FAILED: popen";
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), size);
  }
  return ::pclose(pipe) == 0 ? output : "FAILED: " + output;
}

bool Failed(const std::string& output) { return output.rfind("FAILED", 0) == 0; }

// PostgreSQL refuses to run as root.
std::string AsPostgres(const std::string& command) {
  return ::geteuid() == 0 ? "runuser -u postgres -- " + command : command;
}

}  // namespace

PostgresServer* PostgresServer::Shared(std::string* reason) {
  static std::string failure;
  static const std::unique_ptr<PostgresServer> server = [] {
    std::unique_ptr<PostgresServer> started(new PostgresServer);
    failure = started->Prepare();
    if (!failure.empty()) started.reset();
    return started;
  }();
  *reason = failure;
  return server.get();
}

std::string PostgresServer::Prepare() {
  if (::access((std::string(kPrograms) + "initdb").c_str(), X_OK) != 0) {
    return "PostgreSQL 15 is not installed (apt-get install postgresql)";
  }
  const std::string folder = folder_.File("");
  if (::geteuid() == 0) RunShell("chown postgres " + folder);
  const std::string data = folder_.File("data");
  std::string output = RunShell(AsPostgres(
      absl::StrCat(kPrograms, "initdb -D ", data, " -U homing -A trust -N -E UTF8 --no-locale")));
  if (Failed(output)) return output;
  output = Start();
  is_running_ = !Failed(output);
  return is_running_ ? "" : output;
}

std::string PostgresServer::Control(const std::string& arguments) const {
  return RunShell(AsPostgres(absl::StrCat(kPrograms, "pg_ctl -D ", folder_.File("data"), " -l ",
                                          folder_.File("log"), " -w ", arguments)));
}

PostgresServer::~PostgresServer() {
  if (is_running_) Control("stop -m immediate");
}

void PostgresServer::Crash() { Control("stop -m immediate"); }

std::string PostgresServer::Start() {
  return Control(absl::StrCat("start -o '-c listen_addresses= -c shared_buffers=32MB -k ",
                              folder_.File(""), "'"));
}

std::unique_ptr<PostgresServer> PostgresServer::Copy() const {
  std::unique_ptr<PostgresServer> copy(new PostgresServer);
  RunShell(absl::StrCat("cp -a ", folder_.File("data"), " ", copy->folder_.File("")));
  if (::geteuid() == 0) RunShell("chown postgres " + copy->folder_.File(""));
  copy->is_running_ = true;
  return copy;
}

void PostgresServer::StartPromoted() {
  RunShell(AsPostgres("touch " + folder_.File("data/standby.signal")));
  Start();
  Control("promote");
}

std::string PostgresServer::NewDatabase() {
  const std::string name = absl::StrCat("test", ++databases_);
  Query("postgres", "CREATE DATABASE " + name);
  return UrlOf(name);
}

std::string PostgresServer::UrlOf(const std::string& database) const {
  return absl::StrCat("postgresql://homing@/", database, "?host=", folder_.File(""));
}

std::string PostgresServer::Query(const std::string& database, const std::string& sql) const {
  const std::string file = folder_.File("query.sql");
  std::ofstream(file) << sql << ";\n";
  return RunShell(absl::StrCat(kPrograms, "psql -X -A -t -q -v ON_ERROR_STOP=1 -f ", file, " '",
                               UrlOf(database), "'"));
}

}  // namespace homing::test
