// Whether a key and a certificate belong together.
#ifndef SERVER_ACCESS_KEY_PAIR_H_
#define SERVER_ACCESS_KEY_PAIR_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// PEM files. INVALID_ARGUMENT naming the flag (tls-cert, tls-key) whose file cannot be read, is no
// PEM, or is not the other's. Nothing of the key is repeated.
absl::Status CheckKeyPair(const std::string& certificate_file, const std::string& key_file);

}  // namespace homing::server

#endif  // SERVER_ACCESS_KEY_PAIR_H_
