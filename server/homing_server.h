// The server: opens the store, listens, serves, drains.
#ifndef SERVER_HOMING_SERVER_H_
#define SERVER_HOMING_SERVER_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/catalog/writer_lease.h"
#include "server/config/server_options.h"

namespace homing::server {

// The calls run on their own threads; the methods below are not thread-safe.
class HomingServer {
 public:
  // `clock` is the steady time for leases; default: the machine's. INVALID_ARGUMENT (options);
  // UNAVAILABLE (address in use, store busy); errors of OpenJourneyStore.
  static absl::StatusOr<std::unique_ptr<HomingServer>> Start(
      const ServerOptions& options, std::function<TimePoint()> clock = nullptr);
  // Drains.
  ~HomingServer();

  // "host:port", with the port that was picked.
  const std::string& address() const;
  // "host:port" of the console and of GET /metrics; empty without it.
  std::string metrics_address() const;
  // The console's URL; empty without a console. If logins are required and this is the
  // `first_start`, it contains a login that works once.
  std::string console_link(bool first_start) const;
  // The answer of GET /metrics; empty once drained.
  std::string MetricsText() const;
  // Sets health to NOT_SERVING, ends streams with UNAVAILABLE, commits pending appends and closes
  // the store. Idempotent.
  void Drain();
  // Reads certificates, tokens and roles again at once.
  void Reload();

 private:
  struct State;
  explicit HomingServer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace homing::server

#endif  // SERVER_HOMING_SERVER_H_
