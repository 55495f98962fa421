#include "homing/client/recorder.h"

#include <algorithm>
#include <stop_token>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/journey_client.h"
#include "client/recording_client.h"
#include "client/robot/conversion.h"
#include "client/robot/observation_buffer.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"

namespace homing::robot {
namespace {

// Observations on their way, each up to a frame in size.
constexpr int kWindow = 32;
constexpr std::int64_t kMaxObservations = 10'000'000;

absl::StatusOr<v1::CreateJourneyRequest> CreateRequest(const RecorderOptions& options) {
  HOMING_ASSIGN_OR_RETURN(const client::JourneyName name,
                          client::ParseJourneyName(options.journey));
  if (options.writer.empty()) return absl::InvalidArgumentError("writer must be named");
  v1::CreateJourneyRequest request;
  request.set_parent(name.parent);
  request.set_journey_id(name.journey_id);
  request.set_writer_id(options.writer);
  v1::JourneySettings& settings = *request.mutable_journey()->mutable_settings();
  if (options.left_camera) *settings.mutable_left_camera() = ToMessage(*options.left_camera);
  if (options.right_camera) *settings.mutable_right_camera() = ToMessage(*options.right_camera);
  return request;
}

absl::StatusOr<std::unique_ptr<ObservationBuffer>> MakeBuffer(const RecorderOptions& options) {
  BufferOptions limits;
  limits.max_bytes = options.buffer_bytes;
  limits.max_observations = kMaxObservations;
  limits.memory_observations = options.memory_observations;
  std::optional<ObservationFile> file;
  if (!options.buffer_file.empty()) {
    HOMING_ASSIGN_OR_RETURN(file, ObservationFile::Open(options.buffer_file, options.journey));
  }
  return ObservationBuffer::Create(limits, std::move(file));
}

}  // namespace

class __attribute__((visibility("hidden"))) Recorder::State {
 public:
  State(client::Connection connection, RecorderOptions options, v1::CreateJourneyRequest request,
        std::unique_ptr<ObservationBuffer> buffer)
      : connection_(std::move(connection)),
        options_(std::move(options)),
        request_(std::move(request)),
        buffer_(std::move(buffer)),
        thread_([this] { Run(); }) {}

  ~State() {
    stop_.request_stop();
    buffer_->Stop();
    thread_.join();
  }

  absl::Status Add(const Observation& observation) {
    {
      const MutexLock lock(mutex_);
      if (ended_ && !outcome_.ok()) return outcome_;
    }
    return buffer_->Add(ToMessage(observation)).status();
  }

  std::int64_t pending() const { return buffer_->pending(); }

  absl::Status Finish(std::chrono::milliseconds timeout) {
    buffer_->Close();
    const auto end = std::chrono::steady_clock::now() + timeout;
    const MutexLock lock(mutex_);
    while (!ended_) {
      if (changed_.WaitUntil(mutex_, end)) continue;
      if (ended_) break;
      return absl::DeadlineExceededError(
          absl::StrCat(buffer_->pending(), " observations are not durable yet"));
    }
    return outcome_;
  }

 private:
  void Run() {
    const absl::Status outcome = Record();
    const MutexLock lock(mutex_);
    outcome_ = outcome;
    ended_ = true;
    changed_.NotifyAll();
  }

  absl::Status Record() {
    const std::stop_token stop = stop_.get_token();
    client::JourneyClient journeys(&connection_, stop);
    HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, journeys.Create(request_));
    HOMING_ASSIGN_OR_RETURN(const std::int64_t missing, buffer_->Align(journey.next_sequence()));
    if (missing > 0) TellOfGap(journey.next_sequence(), missing);
    client::RecordingOptions recording;
    recording.journey = options_.journey;
    recording.writer_id = options_.writer;
    recording.window = kWindow;
    client::RecordingClient client(&connection_, recording, [this](const std::string& text) {
      if (options_.on_message) options_.on_message(text);
    });
    HOMING_RETURN_IF_ERROR(
        client
            .Record(
                buffer_.get(),
                [this](const v1::RecordJourneyResponse& answer) { return Take(answer); }, stop)
            .status());
    if (stop.stop_requested()) return absl::CancelledError("stopped");
    return journeys.Finish(options_.journey, options_.writer).status();
  }

  void TellOfGap(std::int64_t durable, std::int64_t missing) const {
    if (!options_.on_message) return;
    options_.on_message(absl::StrCat(
        "the server has only the first ", durable, " observations of ", options_.journey,
        "; at least ", missing,
        " that it had confirmed are lost. It was probably restored from an older backup. The "
        "recording continues with a gap in the map; for a map without one record a new journey"));
  }

  absl::Status Take(const v1::RecordJourneyResponse& answer) {
    // Flow is tracked from the reference, which the server may ask for again. Older servers do not
    // name it.
    const std::int64_t reference =
        answer.has_resend_from() ? answer.resend_from() : answer.next_sequence() - 1;
    buffer_->Acknowledge(answer.next_sequence(), reference);
    if (options_.on_recorded) options_.on_recorded(FromMessage(answer));
    return absl::OkStatus();
  }

  const client::Connection connection_;
  const RecorderOptions options_;
  const v1::CreateJourneyRequest request_;
  const std::unique_ptr<ObservationBuffer> buffer_;
  std::stop_source stop_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  absl::Status outcome_ HOMING_GUARDED_BY(mutex_);
  bool ended_ HOMING_GUARDED_BY(mutex_) = false;
  // Last: it uses all of the above.
  std::thread thread_;
};

Result<std::unique_ptr<Recorder>> Recorder::Open(const Server& server, RecorderOptions options) {
  auto connection = client::Connection::Open(ToConnection(server));
  if (!connection.ok()) return FromAbsl(connection.status());
  auto request = CreateRequest(options);
  if (!request.ok()) return FromAbsl(request.status());
  auto buffer = MakeBuffer(options);
  if (!buffer.ok()) return FromAbsl(buffer.status());
  return std::unique_ptr<Recorder>(new Recorder(std::make_unique<State>(
      *std::move(connection), std::move(options), *std::move(request), *std::move(buffer))));
}

Recorder::Recorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Recorder::~Recorder() = default;
Status Recorder::Add(const Observation& observation) { return FromAbsl(state_->Add(observation)); }
std::int64_t Recorder::pending() const { return state_->pending(); }
Status Recorder::Finish(std::chrono::milliseconds timeout) {
  return FromAbsl(state_->Finish(timeout));
}

}  // namespace homing::robot
