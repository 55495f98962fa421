#include "homing/client/localizer.h"

#include <stop_token>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/homing_client.h"
#include "client/journey_client.h"
#include "client/robot/conversion.h"
#include "client/robot/observation_buffer.h"
#include "homing/base/mutex.h"

namespace homing::robot {
namespace {

constexpr std::int64_t kMaxWaiting = 64;
constexpr std::int64_t kMaxBytes = std::int64_t{1} << 30;

}  // namespace

class __attribute__((visibility("hidden"))) Localizer::State {
 public:
  State(client::Connection connection, const LocalizerOptions& options,
        std::unique_ptr<ObservationBuffer> buffer)
      : connection_(std::move(connection)),
        config_(ToMessage(options)),
        on_message_(options.on_message),
        buffer_(std::move(buffer)),
        thread_([this] { Run(); }) {}

  ~State() {
    stop_.request_stop();
    buffer_->Stop();
    thread_.join();
  }

  absl::StatusOr<Answer> Localize(const Observation& observation,
                                  std::chrono::milliseconds timeout) {
    const auto sequence = buffer_->Add(ToMessage(observation));
    if (!sequence.ok()) return sequence.status();
    const auto end = std::chrono::steady_clock::now() + timeout;
    const MutexLock lock(mutex_);
    while (!ended_ && last_.sequence < *sequence) {
      if (!changed_.WaitUntil(mutex_, end)) break;
    }
    if (last_.sequence == *sequence) return last_;
    if (ended_) return outcome_;
    return absl::DeadlineExceededError(
        absl::StrCat("no answer to observation ", *sequence, " within ", timeout.count(), " ms"));
  }

 private:
  void Run() {
    client::HomingClient client(&connection_, [this](const std::string& text) {
      if (on_message_) on_message_(text);
    });
    client::LocalizingOptions options;
    options.config = config_;
    // The stream begins with the drive: before, the journey need not exist, and no stream stands
    // idle.
    absl::Status outcome = absl::CancelledError("stopped");
    if (buffer_->Await()) {
      outcome = client.Localize(
          options, buffer_.get(),
          [this](const v1::LocalizeResponse& answer) { return Take(answer); }, stop_.get_token());
    }
    const MutexLock lock(mutex_);
    outcome_ = outcome.ok() ? absl::CancelledError("stopped") : outcome;
    ended_ = true;
    changed_.NotifyAll();
  }

  absl::Status Take(const v1::LocalizeResponse& answer) {
    buffer_->Acknowledge(answer.sequence() + 1, answer.sequence() + 1);
    const MutexLock lock(mutex_);
    last_ = FromMessage(answer);
    changed_.NotifyAll();
    return absl::OkStatus();
  }

  const client::Connection connection_;
  const v1::LocalizeConfig config_;
  const std::function<void(const std::string&)> on_message_;
  const std::unique_ptr<ObservationBuffer> buffer_;
  std::stop_source stop_;
  Mutex mutex_;
  ConditionVariable changed_;
  Answer last_ HOMING_GUARDED_BY(mutex_) = NoAnswer();
  absl::Status outcome_ HOMING_GUARDED_BY(mutex_);
  bool ended_ HOMING_GUARDED_BY(mutex_) = false;
  // Last: it uses all of the above.
  std::thread thread_;

  static Answer NoAnswer() {
    Answer none;
    none.sequence = -1;
    return none;
  }
};

Result<std::unique_ptr<Localizer>> Localizer::Open(const Server& server,
                                                   const LocalizerOptions& options) {
  auto connection = client::Connection::Open(ToConnection(server));
  if (!connection.ok()) return FromAbsl(connection.status());
  const auto name = client::ParseJourneyName(options.journey);
  if (!name.ok()) return FromAbsl(name.status());
  BufferOptions limits;
  limits.max_bytes = kMaxBytes;
  limits.max_observations = kMaxWaiting;
  limits.memory_observations = static_cast<int>(kMaxWaiting);
  auto buffer = ObservationBuffer::Create(limits, std::nullopt);
  if (!buffer.ok()) return FromAbsl(buffer.status());
  return std::unique_ptr<Localizer>(
      new Localizer(std::make_unique<State>(*std::move(connection), options, *std::move(buffer))));
}

Localizer::Localizer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Localizer::~Localizer() = default;
Result<Answer> Localizer::Localize(const Observation& observation,
                                   std::chrono::milliseconds timeout) {
  auto answer = state_->Localize(observation, timeout);
  if (!answer.ok()) return FromAbsl(answer.status());
  return *std::move(answer);
}

}  // namespace homing::robot
