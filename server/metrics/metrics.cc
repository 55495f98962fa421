#include "server/metrics/metrics.h"

#include <prometheus/text_serializer.h>

#include <string>
#include <string_view>

#include "server/base/error_reason.h"
#include "server/metrics/metrics_registry.h"

namespace homing::server {
namespace {

// "NOT_FOUND".
std::string CodeOf(const absl::Status& status) {
  return std::string(absl::StatusCodeToString(status.code()));
}

const char* NameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kMatch:
      return "MATCH";
    case Outcome::kAmbiguous:
      return "AMBIGUOUS";
    case Outcome::kUnknownPlace:
      return "UNKNOWN_PLACE";
  }
  return "UNKNOWN";
}

std::string MethodOf(Rpc rpc) { return std::string(TraitsOf(rpc).method); }

}  // namespace

Metrics::Metrics() : state_(std::make_shared<State>()) {}

Metrics::~Metrics() { RemoveGauges(); }

void Metrics::CallStarted(Rpc rpc) {
  state_->started.Add({{"grpc_method", MethodOf(rpc)}}).Increment();
}

void Metrics::CallEnded(Rpc rpc, const absl::Status& status, double seconds) {
  state_->duration
      .Add({{"grpc_method", MethodOf(rpc)}, {"grpc_status", CodeOf(status)}}, kCallSeconds)
      .Observe(seconds);
  if (!status.ok()) {
    state_->errors.Add({{"code", CodeOf(status)}, {"reason", ReasonOf(status).reason}}).Increment();
  }
}

void Metrics::ObservationReceived(Rpc rpc) {
  state_->observations_of
      .Of(static_cast<std::size_t>(rpc), state_->observations,
          [rpc] {
            return prometheus::Labels{{"grpc_method", MethodOf(rpc)}};
          })
      .Increment();
}

void Metrics::ObservationLocalized(Outcome outcome, double seconds) {
  state_->outcomes_of
      .Of(static_cast<std::size_t>(outcome), state_->outcomes,
          [outcome] {
            return prometheus::Labels{{"outcome", NameOf(outcome)}};
          })
      .Increment();
  state_->localize_seconds.Observe(seconds);
}

void Metrics::Committed(int appends, bool ok, double seconds) {
  state_->commits.Add({{"result", ok ? "ok" : "failed"}}).Increment();
  if (ok) {
    state_->steps.Increment(appends);
  }
  state_->commit_seconds.Observe(seconds);
}

void Metrics::AddGauge(const std::string& name, const std::string& help,
                       std::function<double()> value) {
  state_->gauges->Add(name, help, std::move(value));
}

void Metrics::SetLimit(const std::string& name, double value) {
  state_->limits.Add({{"limit", name}}).Set(value);
}

void Metrics::RemoveGauges() { state_->gauges->Clear(); }

std::string Metrics::Text() const {
  auto families = state_->registry->Collect();
  for (prometheus::MetricFamily& family : state_->gauges->Collect()) {
    families.push_back(std::move(family));
  }
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace homing::server
