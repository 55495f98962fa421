// Checks that a key and a certificate belong together.
#ifndef SERVER_ACCESS_KEY_PAIR_H_
#define SERVER_ACCESS_KEY_PAIR_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// PEM files. INVALID_ARGUMENT naming the option (tls-cert, tls-key): its file cannot be read, is
// not PEM, or does not match the other. The message holds nothing of the key.
absl::Status CheckKeyPair(const std::string& certificate_file, const std::string& key_file);

}  // namespace homing::server

#endif  // SERVER_ACCESS_KEY_PAIR_H_
