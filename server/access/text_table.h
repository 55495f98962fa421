// Reads a TOML file with one table of texts: the files of tokens and of roles.
#ifndef SERVER_ACCESS_TEXT_TABLE_H_
#define SERVER_ACCESS_TEXT_TABLE_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"

namespace homing::server {

struct TextTable {
  // False: the file has no table at all, for example because it was cut.
  bool is_present = false;
  std::map<std::string, std::string> entries;
};

// "[table]", which must be the only table. INVALID_ARGUMENT naming `flag` and the file: it cannot
// be read, is not TOML, or holds something else. The message holds no value of the file.
absl::StatusOr<TextTable> ReadTextTable(const std::string& flag, const std::string& path,
                                        const std::string& table);
// The error for a file without "[table]".
absl::Status NoTable(const std::string& flag, const std::string& path, const std::string& table);

}  // namespace homing::server

#endif  // SERVER_ACCESS_TEXT_TABLE_H_
