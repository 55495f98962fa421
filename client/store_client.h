// Copies the server's store.
#ifndef CLIENT_STORE_CLIENT_H_
#define CLIENT_STORE_CLIENT_H_

#include <ostream>
#include <stop_token>

#include "absl/status/status.h"
#include "client/connection.h"

namespace homing::client {

// Writes a copy of the database, an SQLite file. Errors as StoreService.BackUpStore;
// RESOURCE_EXHAUSTED also: `file` cannot be written; CANCELLED: stopped.
absl::Status BackUpStore(const Connection& connection, std::ostream& file,
                         const std::stop_token& stop);

}  // namespace homing::client

#endif  // CLIENT_STORE_CLIENT_H_
