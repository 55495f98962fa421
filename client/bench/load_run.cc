#include "client/bench/load_run.h"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/bench/load_scene.h"
#include "client/journey_client.h"
#include "client/observation_stream.h"
#include "client/recording_client.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "server/process/open_files.h"

namespace homing::client {
namespace {

constexpr char kWriter[] = "bench";
constexpr char kJourney[] = "load";
constexpr int kSceneSteps = 250;
constexpr int kOutDrive = 1;
constexpr int kSecondDrive = 2;
constexpr int kSceneFrames = 60;

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
    const auto& all = scene_->observations();
    v1::Observation observation = all[static_cast<std::size_t>(next_) % all.size()];
    observation.set_sequence(next_++);
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

// One drive along each shared route; all have the same frames.
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

// Records the journeys to localise on; existing ones stay unchanged.
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

template <typename Robot>
class Drive {
 public:
  explicit Drive(const LoadOptions& options) : options_(options), epoll_(epoll_create1(0)) {}
  ~Drive() { close(epoll_); }
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  void Add(std::unique_ptr<Robot> robot) {
    // Edge-triggered: one event for new data or room, after which a robot reads all there is.
    epoll_event event{.events = EPOLLIN | EPOLLOUT | EPOLLRDHUP | EPOLLET, .data = {}};
    event.data.ptr = robot.get();
    epoll_ctl(epoll_, EPOLL_CTL_ADD, robot->socket(), &event);
    robots_.push_back(std::move(robot));
  }

  // Sends at the robots' times, which are spread evenly over a period; each robot sends for
  // `seconds`.
  LoadResult Run(const std::stop_token& stop) {
    using Seconds = std::chrono::duration<double>;
    const LoadClock::time_point start = LoadClock::now() + std::chrono::seconds(1);
    const auto robots = static_cast<std::int64_t>(robots_.size());
    const auto each = static_cast<std::int64_t>(options_.seconds * options_.rate);
    const double ramp = options_.ramp_seconds * options_.rate / static_cast<double>(robots);
    const auto first_of = [ramp](std::int64_t robot) {
      return static_cast<std::int64_t>(ramp * static_cast<double>(robot));
    };
    const std::int64_t all = (first_of(robots - 1) + each) * robots;
    const double between = 1 / options_.rate / static_cast<double>(robots);
    const auto time_of = [&](std::int64_t i) {
      return start + std::chrono::duration_cast<LoadClock::duration>(
                         Seconds(between * static_cast<double>(i)));
    };
    for (std::int64_t next = 0; next < all && !stop.stop_requested(); Tick()) {
      for (; next < all && time_of(next) <= LoadClock::now(); ++next) {
        const std::int64_t robot = next % robots;
        const std::int64_t sent = next / robots - first_of(robot);
        if (sent >= 0 && sent < each) {
          robots_[static_cast<std::size_t>(robot)]->Schedule(time_of(next));
        }
      }
    }
    for (const auto& robot : robots_) robot->HalfClose();
    const auto ended = [](const auto& robot) { return robot->done(); };
    const LoadClock::time_point deadline =
        LoadClock::now() +
        std::chrono::duration_cast<LoadClock::duration>(Seconds(options_.grace_seconds));
    while (!std::all_of(robots_.begin(), robots_.end(), ended) && LoadClock::now() < deadline) {
      Tick();
    }
    LoadResult result = Sum();
    result.seconds = Seconds(LoadClock::now() - start).count();
    return result;
  }

 private:
  // Polls every half millisecond instead of waking up for each answer, to leave the processor to
  // the server.
  void Tick() {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    std::array<epoll_event, 256> events{};
    int count = 0;
    do {
      count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), 0);
      const LoadClock::time_point now = LoadClock::now();
      for (int i = 0; i < count; ++i) {
        const epoll_event& event = events[static_cast<std::size_t>(i)];
        const bool hung_up = (event.events & (EPOLLRDHUP | EPOLLHUP | EPOLLERR)) != 0;
        static_cast<Robot*>(event.data.ptr)->Advance(now, hung_up);
      }
    } while (count == static_cast<int>(events.size()));
  }

  LoadResult Sum() const {
    LoadResult result;
    for (const auto& robot : robots_) {
      const LoadCounts counts = robot->End();
      result.counts.Add(counts);
      if (!counts.status.ok()) {
        ++result.failed_robots;
        result.counts.status = counts.status;
      }
    }
    return result;
  }

  const LoadOptions& options_;
  const int epoll_;
  std::vector<std::unique_ptr<Robot>> robots_;
};

template <typename Request>
std::vector<std::string> RequestsOf(const LoadScene& scene) {
  std::vector<std::string> requests;
  for (const v1::Observation& observation : scene.observations()) {
    Request request;
    *request.mutable_observation() = observation;
    requests.push_back(request.SerializeAsString());
  }
  return requests;
}

// Each robot calls `method` with its own config and scene.
template <typename Request, typename Response, typename Configure>
absl::StatusOr<LoadResult> DriveAll(const ConnectionOptions& connection, const LoadOptions& options,
                                    const std::string& method, const Configure& configure,
                                    const std::vector<LoadScene>& scenes, const LoadLog& log,
                                    const std::stop_token& stop) {
  HOMING_ASSIGN_OR_RETURN(const Http2Endpoint endpoint, Http2Endpoint::Make(connection));
  std::vector<std::vector<std::string>> requests;
  requests.reserve(scenes.size());
  for (const LoadScene& scene : scenes) requests.push_back(RequestsOf<Request>(scene));
  Drive<LoadRobot<Request, Response>> drive(options);
  for (int i = 0; i < options.robots; ++i) {
    const auto& sent = requests[static_cast<std::size_t>(i) % requests.size()];
    HOMING_ASSIGN_OR_RETURN(
        auto robot, (LoadRobot<Request, Response>::Start(endpoint, method, configure(i), &sent)));
    drive.Add(std::move(robot));
  }
  log("all robots are connected");
  return drive.Run(stop);
}

absl::StatusOr<LoadResult> Record(const ConnectionOptions& connection, const LoadOptions& options,
                                  const std::vector<LoadScene>& scenes, const LoadLog& log,
                                  const std::stop_token& stop) {
  const auto configure = [&](int robot) {
    v1::RecordJourneyRequest config;
    config.mutable_config()->set_journey(JourneyOf(options, robot));
    config.mutable_config()->set_writer_id(kWriter);
    return config;
  };
  return DriveAll<v1::RecordJourneyRequest, v1::RecordJourneyResponse>(
      connection, options, "/homing.v1.JourneyService/RecordJourney", configure, scenes, log, stop);
}

absl::StatusOr<LoadResult> Localize(const ConnectionOptions& connection, const LoadOptions& options,
                                    const std::vector<LoadScene>& scenes, const LoadLog& log,
                                    const std::stop_token& stop) {
  const auto configure = [&](int robot) {
    v1::LocalizeRequest config;
    config.mutable_config()->set_journey(JourneyOf(options, robot % options.journeys));
    config.mutable_config()->set_travel(v1::TRAVEL_SAME);
    return config;
  };
  return DriveAll<v1::LocalizeRequest, v1::LocalizeResponse>(
      connection, options, "/homing.v1.HomingService/Localize", configure, scenes, log, stop);
}

}  // namespace

absl::Status Validate(const LoadOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRange("robots", options.robots, 1, 100'000));
  HOMING_RETURN_IF_ERROR(CheckAbove("rate", options.rate, 0.0, 1000.0));
  HOMING_RETURN_IF_ERROR(CheckAbove("seconds", options.seconds, 0.0, 1e6));
  HOMING_RETURN_IF_ERROR(CheckRange("ramp", options.ramp_seconds, 0.0, 1e6));
  HOMING_RETURN_IF_ERROR(CheckAbove("grace", options.grace_seconds, 0.0, 1e6));
  HOMING_RETURN_IF_ERROR(CheckRange("vectors", options.vectors, 0, 100'000));
  HOMING_RETURN_IF_ERROR(CheckRange("journeys", options.journeys, 1, 100'000));
  return CheckRange("steps", options.steps, 1, 1'000'000);
}

absl::StatusOr<LoadResult> RunLoad(const ConnectionOptions& connection, const LoadOptions& options,
                                   const LoadLog& log, const std::stop_token& stop) {
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
    return Localize(connection, options, again, log, stop);
  }
  HOMING_RETURN_IF_ERROR(CreateJourneys(first, options, stop));
  return Record(connection, options, scenes, log, stop);
}

}  // namespace homing::client
