// The server's metrics for Prometheus. Names follow gRFC A66 for calls and Prometheus' rules for
// the rest. No client can choose the value of a label.
#ifndef SERVER_METRICS_METRICS_H_
#define SERVER_METRICS_METRICS_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/localization/localizer.h"
#include "server/access/rpc.h"

namespace homing::server {

// Thread-safe.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void CallStarted(Rpc rpc);
  // Also counts an error by its reason; each limit has its own reason.
  void CallEnded(Rpc rpc, const absl::Status& status, double seconds);
  // Counts one observation of a stream.
  void ObservationReceived(Rpc rpc);
  void ObservationLocalized(Outcome outcome, double seconds);
  // Counts and times one transaction of recorded steps.
  void Committed(int appends, bool ok, double seconds);

  // A gauge whose value is read at each scrape, until RemoveGauges.
  void AddGauge(const std::string& name, const std::string& help, std::function<double()> value);
  // A configured limit, "homing_limit{limit=NAME}".
  void SetLimit(const std::string& name, double value);
  void RemoveGauges();

  // All metrics in Prometheus' text format.
  std::string Text() const;

  struct State;
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace homing::server

#endif  // SERVER_METRICS_METRICS_H_
