#include "server/metrics/metrics_endpoint.h"

#include <prometheus/exposer.h>

#include <exception>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/metrics/metrics_registry.h"

namespace homing::server {
namespace {

// Scrapes come one at a time; the others answer while clients are slow. One that takes longer than
// the limit, ms, is cut off.
constexpr char kThreads[] = "8";
constexpr char kTimeoutMs[] = "2000";

}  // namespace

struct MetricsEndpoint::State {
  State(const std::string& listen, std::shared_ptr<Metrics::State> shown)
      : metrics(std::move(shown)),
        exposer({"listening_ports", listen, "num_threads", kThreads, "request_timeout_ms",
                 kTimeoutMs, "enable_keep_alive", "no"}) {
    exposer.RegisterCollectable(metrics->registry);
    exposer.RegisterCollectable(metrics->gauges);
    address =
        absl::StrCat(listen.substr(0, listen.rfind(':')), ":", exposer.GetListeningPorts().front());
  }

  const std::shared_ptr<Metrics::State> metrics;
  prometheus::Exposer exposer;
  std::string address;
};

MetricsEndpoint::MetricsEndpoint(std::unique_ptr<State> state) : state_(std::move(state)) {}

MetricsEndpoint::~MetricsEndpoint() = default;

const std::string& MetricsEndpoint::address() const { return state_->address; }

absl::StatusOr<std::unique_ptr<MetricsEndpoint>> MetricsEndpoint::Start(const std::string& address,
                                                                        const Metrics& metrics) {
  try {
    return std::unique_ptr<MetricsEndpoint>(
        new MetricsEndpoint(std::make_unique<State>(address, metrics.state())));
  } catch (const std::exception&) {
    return absl::UnavailableError(absl::StrCat("http: \"", address,
                                               "\" is in use or is not an address of this "
                                               "machine"));
  }
}

}  // namespace homing::server
