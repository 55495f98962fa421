#include "server/metrics/metrics_registry.h"

#include <string>
#include <utility>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "homing/base/mutex.h"
#include "server/base/error_reason.h"

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

// The reasons that the server gives, with their codes; others have the code as their reason.
constexpr std::pair<const char*, const char*> kReasons[] = {
    {"UNAUTHENTICATED", "NO_CREDENTIALS"},
    {"UNAUTHENTICATED", "BAD_TOKEN"},
    {"UNAUTHENTICATED", "ROLE_CHANGED"},
    {"PERMISSION_DENIED", "NOT_ALLOWED"},
    {"RESOURCE_EXHAUSTED", "STREAMS"},
    {"RESOURCE_EXHAUSTED", "ROBOT_STREAMS"},
    {"RESOURCE_EXHAUSTED", "RATE"},
    {"RESOURCE_EXHAUSTED", "ROBOT_JOURNEYS"},
    {"RESOURCE_EXHAUSTED", "ROBOT_BYTES"},
    {"INVALID_ARGUMENT", "PIXELS"},
    {"INVALID_ARGUMENT", "VECTORS"},
    {"RESOURCE_EXHAUSTED", "IMPORT_MEMORY"},
    {"RESOURCE_EXHAUSTED", "EXPORT_MEMORY"},
    {"RESOURCE_EXHAUSTED", "ANSWER_MEMORY"},
    {"RESOURCE_EXHAUSTED", "REQUEST_MEMORY"},
    {"RESOURCE_EXHAUSTED", "LOCALIZE_MEMORY"},
    {"RESOURCE_EXHAUSTED", "IMAGE_MEMORY"},
    {"RESOURCE_EXHAUSTED", "MAP_CACHE"},
    {"RESOURCE_EXHAUSTED", "BUSY"},
    {"RESOURCE_EXHAUSTED", "UNREAD"},
    {"RESOURCE_EXHAUSTED", "WATCHES"},
    {"DEADLINE_EXCEEDED", "REQUEST_TIME"},
    {"OUT_OF_RANGE", "SEQUENCE_GAP"},
    {"UNAVAILABLE", "IDLE"},
    {"UNAVAILABLE", "DRAINING"},
    {"UNAVAILABLE", "INDEX_NOT_READY"},
    {"ABORTED", "WRITER_REPLACED"},
    {"ABORTED", "WRITER_LEASE_HELD"},
    {"ABORTED", "JOURNEY_DELETED"},
    {"FAILED_PRECONDITION", "JOURNEY_FINISHED"},
    {"FAILED_PRECONDITION", "OTHER_INPUT"},
    {"FAILED_PRECONDITION", "OTHER_SETTINGS"},
    {"UNAUTHENTICATED", "BAD_CERTIFICATE"},
};

void AddErrors(Family<prometheus::Counter>* errors) {
  for (int code = 1; code <= 16; ++code) {
    const absl::Status status(static_cast<absl::StatusCode>(code), "");
    errors->Add({{"code", std::string(absl::StatusCodeToString(status.code()))},
                 {"reason", ReasonOf(status).reason}});
  }
  for (const auto& [code, reason] : kReasons) errors->Add({{"code", code}, {"reason", reason}});
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
                         .Add({}, kWorkSeconds)) {
  // Each series exists from the start: otherwise rate() misses the first event.
  for (const RpcTraits& traits : kRpcs) {
    const std::string method(traits.method);
    started.Add({{"grpc_method", method}});
    duration.Add({{"grpc_method", method}, {"grpc_status", "OK"}}, kCallSeconds);
    if (traits.right == Right::kLocalize || traits.right == Right::kWrite) {
      observations.Add({{"grpc_method", method}});
    }
  }
  for (const char* outcome : {"MATCH", "AMBIGUOUS", "UNKNOWN_PLACE"}) {
    outcomes.Add({{"outcome", outcome}});
  }
  for (const char* result : {"ok", "failed"}) commits.Add({{"result", result}});
  AddErrors(&errors);
  prometheus::BuildGauge()
      .Name("homing_build_info")
      .Help("1, with the version of the server")
      .Register(*registry)
      .Add({{"version", HOMING_VERSION}})
      .Set(1);
  prometheus::BuildGauge()
      .Name("process_start_time_seconds")
      .Help("When the server started, Unix time")
      .Register(*registry)
      .Add({})
      .Set(absl::ToDoubleSeconds(absl::Now() - absl::UnixEpoch()));
}

}  // namespace homing::server
