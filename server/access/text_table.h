// A TOML file with one table of texts: the form of the files of tokens and of roles.
#ifndef SERVER_ACCESS_TEXT_TABLE_H_
#define SERVER_ACCESS_TEXT_TABLE_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"

namespace homing::server {

// The entries of "[table]", which must be all that the file holds. INVALID_ARGUMENT naming `flag`
// and the file: it cannot be read, is no TOML, or holds something else. No value is repeated in it.
absl::StatusOr<std::map<std::string, std::string>> ReadTextTable(const std::string& flag,
                                                                 const std::string& path,
                                                                 const std::string& table);

}  // namespace homing::server

#endif  // SERVER_ACCESS_TEXT_TABLE_H_
