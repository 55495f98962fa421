// The server: opens the store, listens, serves, drains. Source: own design.
#ifndef SERVER_HOMING_SERVER_H_
#define SERVER_HOMING_SERVER_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/catalog/writer_lease.h"
#include "server/config/server_options.h"

namespace homing::server {

class HomingServer {
 public:
  // `clock` is steady time, for leases; by default the machine's. INVALID_ARGUMENT (options);
  // UNAVAILABLE (address in use, store busy); as OpenJourneyStore.
  static absl::StatusOr<std::unique_ptr<HomingServer>> Start(
      const ServerOptions& options, std::function<TimePoint()> clock = nullptr);
  // Drains.
  ~HomingServer();

  // "host:port", with the port that was picked.
  const std::string& address() const;
  // "host:port" of GET /metrics; empty: there is none.
  std::string metrics_address() const;
  // What GET /metrics answers; empty once drained.
  std::string MetricsText() const;
  // Health says NOT_SERVING, streams end with UNAVAILABLE, what waits for the disk is written, the
  // store is closed. Idempotent.
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
