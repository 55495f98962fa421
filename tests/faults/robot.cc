#include "tests/faults/robot.h"

#include <deque>
#include <sstream>
#include <thread>

#include "absl/strings/str_cat.h"
#include "client/homing_client.h"
#include "client/journey_client.h"
#include "client/recording_client.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "proto/wire/observation_conversion.h"
#include "tests/support/route.h"

namespace homing::faults {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPlacesBetweenRobots = 137;

class Route final : public client::ObservationStream {
 public:
  explicit Route(const RobotOptions& options) : options_(options) {}

  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    if (next_ >= options_.observations) return std::nullopt;
    std::this_thread::sleep_for(options_.pace);
    return At(next_++);
  }
  bool Seek(std::int64_t sequence) override {
    next_ = sequence;
    return true;
  }
  void ContinueAt(std::int64_t sequence) override { next_ = sequence; }

 private:
  v1::Observation At(std::int64_t sequence) const {
    const int place = kPlacesBetweenRobots * options_.robot + static_cast<int>(sequence);
    if (!options_.sends_frames()) return wire::ToProto(test::FlowAt(sequence, place));
    const std::string left = test::WallAt(place, Side::kLeft);
    const std::string right = test::WallAt(place, Side::kRight);
    Observation observation;
    observation.sequence = sequence;
    observation.views = {test::GrayFrame(left), test::GrayFrame(right)};
    return wire::ToProto(observation);
  }

  const RobotOptions options_;
  std::int64_t next_ = 0;
};

// Notes when each observation was first taken.
class Timed final : public client::ObservationStream {
 public:
  explicit Timed(std::unique_ptr<client::ObservationStream> stream) : stream_(std::move(stream)) {}

  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    auto next = stream_->Next();
    if (next.ok() && *next) {
      const MutexLock lock(mutex_);
      taken_[(*next)->sequence()] = Clock::now();
    }
    return next;
  }
  void set_last_frame(std::int64_t frame) override { stream_->set_last_frame(frame); }
  bool Seek(std::int64_t sequence) override { return stream_->Seek(sequence); }
  void ContinueAt(std::int64_t sequence) override { stream_->ContinueAt(sequence); }

  std::chrono::microseconds Since(std::int64_t sequence) {
    const MutexLock lock(mutex_);
    const auto since = Clock::now() - taken_[sequence];
    taken_.erase(taken_.begin(), taken_.upper_bound(sequence));
    return std::chrono::duration_cast<std::chrono::microseconds>(since);
  }

 private:
  std::unique_ptr<client::ObservationStream> stream_;
  Mutex mutex_;
  std::map<std::int64_t, Clock::time_point> taken_;
};

absl::StatusOr<client::Connection> Connect(const std::string& address,
                                           std::chrono::milliseconds retry_for) {
  client::ConnectionOptions options;
  options.address = address;
  options.retry_for = retry_for;
  HOMING_ASSIGN_OR_RETURN(client::Connection connection, client::Connection::Open(options));
  // One that does not try again must at least not miss the server (tests/support/connected.h).
  if (retry_for == retry_for.zero()) HOMING_RETURN_IF_ERROR(connection.WaitForServer());
  return connection;
}

std::string WriterOf(const RobotOptions& options) { return absl::StrCat("robot-", options.robot); }

}  // namespace

std::unique_ptr<client::ObservationStream> RouteOf(const RobotOptions& options) {
  return std::make_unique<Route>(options);
}

absl::Status RecordOne(const RobotOptions& options, const std::string& journey, Ledger* ledger) {
  HOMING_ASSIGN_OR_RETURN(const client::Connection connection,
                          Connect(options.address, options.retry_for));
  client::JourneyClient journeys(&connection);
  HOMING_ASSIGN_OR_RETURN(const client::JourneyName name, client::ParseJourneyName(journey));
  v1::CreateJourneyRequest create;
  create.set_parent(name.parent);
  create.set_journey_id(name.journey_id);
  create.set_writer_id(WriterOf(options));
  HOMING_RETURN_IF_ERROR(journeys.Create(create).status());
  ledger->Created(journey, options.sends_frames());
  options.log("created");
  Timed route(RouteOf(options));
  client::RecordingClient recording(&connection, {journey, WriterOf(options)}, options.log);
  HOMING_RETURN_IF_ERROR(recording
                             .Record(&route,
                                     [&](const v1::RecordJourneyResponse& answer) {
                                       ledger->Advanced(journey, answer.next_sequence());
                                       options.on_answer(route.Since(answer.sequence()));
                                       return absl::OkStatus();
                                     })
                             .status());
  options.log("recorded");
  HOMING_RETURN_IF_ERROR(journeys.Finish(journey, WriterOf(options)).status());
  ledger->Finished(journey);
  options.log("finished");
  return absl::OkStatus();
}

absl::StatusOr<double> LocalizeOn(const RobotOptions& options, const std::string& journey) {
  HOMING_ASSIGN_OR_RETURN(const client::Connection connection,
                          Connect(options.address, options.retry_for));
  client::HomingClient homing(&connection, options.log);
  client::LocalizingOptions localizing;
  localizing.config.set_journey(journey);
  localizing.config.set_travel(v1::TRAVEL_SAME);
  int answers = 0;
  int matches = 0;
  Timed route(RouteOf(options));
  HOMING_RETURN_IF_ERROR(
      homing.Localize(localizing, &route, [&](const v1::LocalizeResponse& answer) {
        ++answers;
        matches += answer.outcome() == v1::OUTCOME_MATCH;
        options.on_answer(route.Since(answer.sequence()));
        return absl::OkStatus();
      }));
  return answers == 0 ? 0.0 : static_cast<double>(matches) / answers;
}

absl::StatusOr<std::string> ExportOne(const std::string& address, const std::string& journey) {
  HOMING_ASSIGN_OR_RETURN(const client::Connection connection,
                          Connect(address, std::chrono::seconds(60)));
  client::JourneyClient journeys(&connection);
  std::ostringstream file;
  HOMING_RETURN_IF_ERROR(journeys.Export(journey, file));
  return file.str();
}

absl::Status DeleteOne(const RobotOptions& options, const std::string& journey) {
  HOMING_ASSIGN_OR_RETURN(const client::Connection connection,
                          Connect(options.address, options.retry_for));
  return client::JourneyClient(&connection).Delete(journey);
}

std::string JourneyOf(int robot, int number) {
  return absl::StrCat("robots/", robot, "/journeys/", number);
}

}  // namespace homing::faults
