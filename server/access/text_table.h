// Reads a TOML file with one table of texts: the files of tokens and of roles.
#ifndef SERVER_ACCESS_TEXT_TABLE_H_
#define SERVER_ACCESS_TEXT_TABLE_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"

namespace homing::server {

// The entries of "[table]", which must be the only table. INVALID_ARGUMENT naming `flag` and the
// file: it cannot be read, is not TOML, or holds something else. The message holds no value of the
// file.
absl::StatusOr<std::map<std::string, std::string>> ReadTextTable(const std::string& flag,
                                                                 const std::string& path,
                                                                 const std::string& table);

}  // namespace homing::server

#endif  // SERVER_ACCESS_TEXT_TABLE_H_
