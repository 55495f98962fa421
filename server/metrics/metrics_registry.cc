#include "server/metrics/metrics_registry.h"

#include <utility>

#include "homing/base/mutex.h"

namespace homing::server {
namespace {

using prometheus::Family;

Family<prometheus::Counter>& Counters(prometheus::Registry* registry, const char* name,
                                      const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(*registry);
}

Family<prometheus::Histogram>& Histograms(prometheus::Registry* registry, const char* name,
                                          const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(*registry);
}

}  // namespace

void LiveGauges::Add(const std::string& name, const std::string& help,
                     std::function<double()> value) {
  const MutexLock lock(mutex_);
  entries_.push_back({name, help, std::move(value)});
}

void LiveGauges::Clear() {
  const MutexLock lock(mutex_);
  entries_.clear();
}

std::vector<prometheus::MetricFamily> LiveGauges::Collect() const {
  const MutexLock lock(mutex_);
  std::vector<prometheus::MetricFamily> families;
  for (const Entry& entry : entries_) {
    prometheus::ClientMetric metric;
    metric.gauge.value = entry.read();
    families.push_back({entry.name, entry.help, prometheus::MetricType::Gauge, {metric}});
  }
  return families;
}

Metrics::State::State()
    : started(Counters(registry.get(), "grpc_server_call_started_total",
                       "Calls that began, by method")),
      duration(Histograms(registry.get(), "grpc_server_call_duration_seconds",
                          "Time from a call's beginning to its end, by method and status")),
      errors(Counters(registry.get(), "homing_errors_total",
                      "Calls that ended in an error, by code and reason; a limit is a reason")),
      observations(Counters(registry.get(), "homing_observations_received_total",
                            "Observations of streams, by method")),
      outcomes(Counters(registry.get(), "homing_query_results_total",
                        "Answers of Localize, by outcome")),
      commits(Counters(registry.get(), "homing_db_commits_total",
                       "Transactions of recorded steps, by result")),
      limits(prometheus::BuildGauge()
                 .Name("homing_limit")
                 .Help("Limits as set; 0: none")
                 .Register(*registry)),
      steps(
          Counters(registry.get(), "homing_db_appends_total", "Observations made durable").Add({})),
      localize_seconds(Histograms(registry.get(), "homing_query_duration_seconds",
                                  "Computing one answer of Localize")
                           .Add({}, kWorkSeconds)),
      commit_seconds(Histograms(registry.get(), "homing_db_commit_duration_seconds",
                                "One transaction of recorded steps, to the disk and back")
                         .Add({}, kWorkSeconds)) {}

}  // namespace homing::server
