#include <filesystem>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/command/commands.h"
#include "client/command/json_line.h"
#include "client/file/output_file.h"
#include "client/store_client.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// SQLite would apply the log of the file before to the copy.
absl::Status CheckHasNoLog(const std::string& path) {
  const std::string log = path + "-wal";
  std::error_code ignored;
  if (!std::filesystem::exists(log, ignored)) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat("'", path, "' is a database in use, '", log,
                                                    "' belongs to it; name another file"));
}

absl::Status BackUp(const Session& session, const std::string& path) {
  HOMING_RETURN_IF_ERROR(CheckHasNoLog(path));
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  const auto write = [&](std::ostream& file) {
    return BackUpStore(connection, file, session.stop);
  };
  if (path == "-") return WriteStandardOutput(write);
  HOMING_ASSIGN_OR_RETURN(const std::uintmax_t bytes, WriteOutputFile(path, write, session.stop));
  if (session.json) return session.PrintJson(Json{{"file", path}, {"bytes", bytes}});
  return session.Print(WrittenFile(path, bytes));
}

}  // namespace

void AddBackupCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand("backup", "Copy the server's whole database to one file");
  auto path = std::make_shared<std::string>();
  command.add_option("file,--out", *path, "FILE to write, - for stdout")->required();
  command.callback(
      [path, &session] { session.run = [path, &session] { return BackUp(session, *path); }; });
}

}  // namespace homing::client
