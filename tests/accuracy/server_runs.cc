#include "tests/accuracy/server_runs.h"

#include <optional>
#include <utility>

#include "client/journey_client.h"
#include "client/recording_client.h"
#include "proto/wire/observation_conversion.h"
#include "tests/accuracy/drive.h"

namespace homing::accuracy {
namespace {

constexpr char kWriter[] = "accuracy";

class Stream final : public client::ObservationStream {
 public:
  explicit Stream(const Observations* observations) : observations_(observations) {}

  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    if (next_ >= observations_->count) return std::optional<v1::Observation>();
    return std::make_optional(wire::ToProto(observations_->At(next_++)));
  }
  bool Seek(std::int64_t sequence) override {
    next_ = static_cast<std::size_t>(sequence);
    return true;
  }
  void ContinueAt(std::int64_t /*sequence*/) override {}

 private:
  const Observations* observations_;
  std::size_t next_ = 0;
};

void Check(const absl::Status& status) {
  if (!status.ok()) Fail(status.ToString());
}

}  // namespace

Observation Observations::At(std::size_t sequence) const {
  Observation observation;
  observation.sequence = static_cast<std::int64_t>(sequence);
  ObservedFlow observed = flow(sequence);
  for (std::size_t side = 0; side < 2; ++side) {
    if (observed.fields[side]) observation.views[side] = *std::move(observed.fields[side]);
  }
  return observation;
}

void RecordOnServer(const client::Connection& server, const std::string& journey,
                    const Observations& observations) {
  client::JourneyClient journeys(&server);
  const auto parsed = client::ParseJourneyName(journey);
  v1::CreateJourneyRequest request;
  request.set_parent(parsed->parent);
  request.set_journey_id(parsed->journey_id);
  request.set_writer_id(kWriter);
  Check(journeys.Create(request).status());
  client::RecordingClient recording(&server, {.journey = journey, .writer_id = kWriter});
  Stream stream(&observations);
  Check(recording.Record(&stream, [](const auto&) { return absl::OkStatus(); }).status());
  Check(journeys.Finish(journey, kWriter).status());
}

void LocalizeOnServer(const client::Connection& server, const client::LocalizingOptions& options,
                      const Observations& observations,
                      const std::function<void(const v1::LocalizeResponse&)>& take) {
  Stream stream(&observations);
  client::HomingClient homing(&server);
  Check(homing.Localize(options, &stream, [&take](const v1::LocalizeResponse& response) {
    take(response);
    return absl::OkStatus();
  }));
}

void DeleteOnServer(const client::Connection& server, const std::string& journey) {
  Check(client::JourneyClient(&server).Delete(journey));
}

}  // namespace homing::accuracy
