#include "client/load/load_run.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/journey_client.h"
#include "client/load/load_scene.h"
#include "client/observation_stream.h"
#include "client/recording_client.h"
#include "homing/open_files.h"
#include "homing/range_check.h"
#include "homing/status_macros.h"
#include "homing/v1/homing_service.grpc.pb.h"
#include "homing/v1/journey_service.grpc.pb.h"

namespace homing::client {
namespace {

using RecordRobot = LoadRobot<v1::RecordJourneyRequest, v1::RecordJourneyResponse>;
using LocalizeRobot = LoadRobot<v1::LocalizeRequest, v1::LocalizeResponse>;

constexpr char kWriter[] = "bench";
constexpr char kJourney[] = "load";
constexpr int kSceneSteps = 250;
constexpr int kOutDrive = 1;
constexpr int kSecondDrive = 2;
constexpr int kSceneFrames = 60;
// For the last answers, after the last observation.
constexpr std::chrono::seconds kGrace{30};

std::string RobotOf(const LoadOptions& options, int robot) {
  return absl::StrCat("robots/", options.prefix, robot);
}

std::string JourneyOf(const LoadOptions& options, int robot) {
  return absl::StrCat(RobotOf(options, robot), "/journeys/", kJourney);
}

// To the end of `steps`.
class SceneStream final : public ObservationStream {
 public:
  SceneStream(const LoadScene* scene, int steps) : scene_(scene), steps_(steps) {}
  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    if (next_ >= steps_) return std::nullopt;
    v1::Observation observation;
    scene_->Fill(next_++, &observation);
    return observation;
  }
  bool Seek(std::int64_t sequence) override {
    next_ = sequence;
    return true;
  }
  void ContinueAt(std::int64_t sequence) override { next_ = sequence; }

 private:
  const LoadScene* scene_;
  const int steps_;
  std::int64_t next_ = 0;
};

absl::StatusOr<LoadScene> MakeScene(const LoadOptions& options, int route, int drive, int steps) {
  if (options.frames) return LoadScene::WithFrames(kSceneFrames);
  return LoadScene::WithFlow(route, drive, steps, options.vectors);
}

// One drive along each route that is shared; all have the same frames.
absl::StatusOr<std::vector<LoadScene>> MakeScenes(const LoadOptions& options, int drive) {
  const bool shared = options.localize || options.prepare_only;
  std::vector<LoadScene> scenes;
  for (int i = 0; i < (shared && !options.frames ? options.journeys : 1); ++i) {
    HOMING_ASSIGN_OR_RETURN(LoadScene scene,
                            MakeScene(options, i, drive, shared ? options.steps : kSceneSteps));
    scenes.push_back(std::move(scene));
  }
  if (shared) scenes.resize(static_cast<std::size_t>(options.journeys), scenes.front());
  return scenes;
}

// The journeys that are localised on; those that are there already are left as they are.
absl::Status RecordJourneys(const Connection& connection, const LoadOptions& options,
                            const std::vector<LoadScene>& scenes, const std::stop_token& stop) {
  JourneyClient journeys(&connection, stop);
  for (int i = 0; i < options.journeys; ++i) {
    v1::CreateJourneyRequest create;
    create.set_parent(RobotOf(options, i));
    create.set_journey_id(kJourney);
    create.set_writer_id(kWriter);
    const auto created = journeys.Create(create);
    if (absl::IsAlreadyExists(created.status())) continue;
    HOMING_RETURN_IF_ERROR(created.status());
    RecordingClient client(&connection, {JourneyOf(options, i), kWriter, 256, 8});
    SceneStream stream(&scenes[static_cast<std::size_t>(i)], options.steps);
    HOMING_RETURN_IF_ERROR(client
                               .Record(
                                   &stream, [](const auto&) { return absl::OkStatus(); }, stop)
                               .status());
    HOMING_RETURN_IF_ERROR(journeys.Finish(JourneyOf(options, i), kWriter).status());
  }
  return absl::OkStatus();
}

absl::Status CreateJourneys(const Connection& connection, const LoadOptions& options,
                            const std::stop_token& stop) {
  JourneyClient journeys(&connection, stop);
  for (int robot = 0; robot < options.robots; ++robot) {
    v1::CreateJourneyRequest create;
    create.set_parent(RobotOf(options, robot));
    create.set_journey_id(kJourney);
    create.set_writer_id(kWriter);
    HOMING_RETURN_IF_ERROR(journeys.Create(create).status());
  }
  return absl::OkStatus();
}

template <typename Stub>
struct Robots {
  std::vector<Connection> connections;
  std::vector<std::unique_ptr<Stub>> stubs;
};

template <typename Service>
absl::StatusOr<Robots<typename Service::Stub>> Connect(const ConnectionOptions& options,
                                                       int robots) {
  Robots<typename Service::Stub> all;
  for (int i = 0; i < robots; ++i) {
    HOMING_ASSIGN_OR_RETURN(Connection connection, Connection::Open(options));
    all.stubs.push_back(Service::NewStub(connection.channel()));
    all.connections.push_back(std::move(connection));
  }
  return all;
}

// Sends at the robots' times, which are spread evenly over a period, until `seconds` are over.
template <typename Robot>
LoadResult Drive(const std::vector<std::unique_ptr<Robot>>& robots, const LoadOptions& options,
                 const std::stop_token& stop) {
  using Seconds = std::chrono::duration<double>;
  const LoadClock::time_point start = LoadClock::now() + std::chrono::seconds(1);
  const auto rounds = static_cast<std::int64_t>(options.seconds * options.rate);
  const double between = 1 / options.rate / static_cast<double>(robots.size());
  std::int64_t next = 0;
  for (std::int64_t round = 0; round < rounds && !stop.stop_requested(); ++round) {
    for (const std::unique_ptr<Robot>& robot : robots) {
      const LoadClock::time_point time =
          start + std::chrono::duration_cast<LoadClock::duration>(
                      Seconds(between * static_cast<double>(next++)));
      if (time > LoadClock::now() + std::chrono::microseconds(200)) {
        std::this_thread::sleep_until(time);
      }
      robot->Due(time);
    }
  }
  for (const std::unique_ptr<Robot>& robot : robots) robot->HalfClose();
  LoadResult result;
  for (const std::unique_ptr<Robot>& robot : robots) {
    const LoadCounts counts = robot->Await(LoadClock::now() + kGrace);
    result.counts.sent += counts.sent;
    result.counts.answered += counts.answered;
    result.counts.late += counts.late;
    result.counts.latency.Add(counts.latency);
    if (!counts.status.ok()) {
      ++result.failed_robots;
      result.counts.status = counts.status;
    }
  }
  result.seconds = Seconds(LoadClock::now() - start).count();
  return result;
}

absl::StatusOr<LoadResult> Record(const ConnectionOptions& connection, const LoadOptions& options,
                                  const std::vector<LoadScene>& scenes,
                                  const std::stop_token& stop) {
  HOMING_ASSIGN_OR_RETURN(const auto all, Connect<v1::JourneyService>(connection, options.robots));
  std::vector<std::unique_ptr<RecordRobot>> robots;
  for (int i = 0; i < options.robots; ++i) {
    v1::RecordJourneyRequest config;
    config.mutable_config()->set_journey(JourneyOf(options, i));
    config.mutable_config()->set_writer_id(kWriter);
    const LoadScene* scene = &scenes[static_cast<std::size_t>(i) % scenes.size()];
    robots.push_back(std::make_unique<RecordRobot>(config, [scene](auto sequence, auto* request) {
      scene->Fill(sequence, request->mutable_observation());
    }));
    robots.back()->Start([&](grpc::ClientContext* context, RecordRobot* robot) {
      all.stubs[static_cast<std::size_t>(i)]->async()->RecordJourney(context, robot);
    });
  }
  return Drive(robots, options, stop);
}

absl::StatusOr<LoadResult> Localize(const ConnectionOptions& connection, const LoadOptions& options,
                                    const std::vector<LoadScene>& scenes,
                                    const std::stop_token& stop) {
  HOMING_ASSIGN_OR_RETURN(const auto all, Connect<v1::HomingService>(connection, options.robots));
  std::vector<std::unique_ptr<LocalizeRobot>> robots;
  for (int i = 0; i < options.robots; ++i) {
    v1::LocalizeRequest config;
    config.mutable_config()->set_journey(JourneyOf(options, i % options.journeys));
    config.mutable_config()->set_travel(v1::TRAVEL_SAME);
    const LoadScene* scene = &scenes[static_cast<std::size_t>(i % options.journeys)];
    robots.push_back(std::make_unique<LocalizeRobot>(config, [scene](auto sequence, auto* request) {
      scene->Fill(sequence, request->mutable_observation());
    }));
    robots.back()->Start([&](grpc::ClientContext* context, LocalizeRobot* robot) {
      all.stubs[static_cast<std::size_t>(i)]->async()->Localize(context, robot);
    });
  }
  return Drive(robots, options, stop);
}

}  // namespace

absl::Status Validate(const LoadOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRange("robots", options.robots, 1, 100'000));
  HOMING_RETURN_IF_ERROR(CheckAbove("rate", options.rate, 0.0, 1000.0));
  HOMING_RETURN_IF_ERROR(CheckAbove("seconds", options.seconds, 0.0, 1e6));
  HOMING_RETURN_IF_ERROR(CheckRange("vectors", options.vectors, 0, 100'000));
  HOMING_RETURN_IF_ERROR(CheckRange("journeys", options.journeys, 1, 100'000));
  return CheckRange("steps", options.steps, 1, 1'000'000);
}

absl::StatusOr<LoadResult> RunLoad(const ConnectionOptions& connection, const LoadOptions& options,
                                   const std::function<void(const std::string&)>& log,
                                   const std::stop_token& stop) {
  HOMING_RETURN_IF_ERROR(Validate(options));
  RaiseOpenFileLimit();
  HOMING_ASSIGN_OR_RETURN(const Connection first, Connection::Open(connection));
  HOMING_RETURN_IF_ERROR(first.WaitForServer());
  HOMING_ASSIGN_OR_RETURN(const std::vector<LoadScene> scenes, MakeScenes(options, kOutDrive));
  if (options.localize || options.prepare_only) {
    log("recording the journeys to localise on");
    HOMING_RETURN_IF_ERROR(RecordJourneys(first, options, scenes, stop));
    if (options.prepare_only) return LoadResult{};
    HOMING_ASSIGN_OR_RETURN(const std::vector<LoadScene> again, MakeScenes(options, kSecondDrive));
    return Localize(connection, options, again, stop);
  }
  HOMING_RETURN_IF_ERROR(CreateJourneys(first, options, stop));
  return Record(connection, options, scenes, stop);
}

}  // namespace homing::client
