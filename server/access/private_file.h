// Files that only their owner may read: keys and tokens.
#ifndef SERVER_ACCESS_PRIVATE_FILE_H_
#define SERVER_ACCESS_PRIVATE_FILE_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// Writes (replacing the content) or appends. A new file has mode 0600 from the first byte on. A
// link stays a link; devices and pipes are written into. INVALID_ARGUMENT naming the path.
absl::Status WritePrivateFile(const std::string& path, const std::string& text);
absl::Status AppendPrivateFile(const std::string& path, const std::string& text);

}  // namespace homing::server

#endif  // SERVER_ACCESS_PRIVATE_FILE_H_
