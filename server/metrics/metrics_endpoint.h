// GET /metrics over HTTP.
#ifndef SERVER_METRICS_METRICS_ENDPOINT_H_
#define SERVER_METRICS_METRICS_ENDPOINT_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/metrics/metrics.h"

namespace homing::server {

class MetricsEndpoint {
 public:
  // `address` is host:port; port 0 picks one. UNAVAILABLE: it is in use or not available.
  static absl::StatusOr<std::unique_ptr<MetricsEndpoint>> Start(const std::string& address,
                                                                const Metrics& metrics);
  ~MetricsEndpoint();

  // "host:port", with the port that was picked.
  const std::string& address() const;

 private:
  struct State;
  explicit MetricsEndpoint(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace homing::server

#endif  // SERVER_METRICS_METRICS_ENDPOINT_H_
