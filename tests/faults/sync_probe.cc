// Commits 1, 2, 3... to an SQLite file in WAL mode and prints each number once it is committed.
// usage: sync_probe FILE FULL|OFF          (what `synchronous` is set to)
#include <iostream>
#include <string>

#include "homing/base/status_macros.h"
#include "storage/connection.h"

namespace homing::storage {
namespace {

absl::Status Write(const std::string& path, const std::string& synchronous) {
  HOMING_ASSIGN_OR_RETURN(const auto connection,
                          Connection::Open(path, Connection::Access::kReadWrite, 1000));
  HOMING_RETURN_IF_ERROR(connection->Run([&] {
    connection->Text("PRAGMA journal_mode=WAL");
    connection->Execute("PRAGMA synchronous=" + synchronous);
    connection->Execute("PRAGMA wal_autocheckpoint=50");
    connection->Execute("CREATE TABLE IF NOT EXISTS numbers (n INTEGER PRIMARY KEY, b BLOB)");
    return absl::OkStatus();
  }));
  for (int n = 1;; ++n) {
    HOMING_RETURN_IF_ERROR(connection->Write([&] {
      connection->Prepare("INSERT INTO numbers VALUES (?, zeroblob(3000))", n).Run();
      return absl::OkStatus();
    }));
    std::cout << n << std::endl;
  }
}

}  // namespace
}  // namespace homing::storage

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::cerr << homing::storage::Write(argv[1], argv[2]).ToString() << '\n';
  return 1;
}
