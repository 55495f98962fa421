#include "server/admission/stream_limiter.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

// The last quarter of all places is for robots with fewer streams than this.
constexpr int kKeptPart = 4;
constexpr int kFewStreams = 16;

}  // namespace

StreamLimiter::Slot::Slot(StreamLimiter* limiter, std::string robot)
    : limiter_(limiter), robot_(std::move(robot)) {}

StreamLimiter::Slot::Slot(Slot&& other) noexcept
    : limiter_(std::exchange(other.limiter_, nullptr)), robot_(std::move(other.robot_)) {}

StreamLimiter::Slot& StreamLimiter::Slot::operator=(Slot&& other) noexcept {
  if (this != &other) {
    Leave();
    limiter_ = std::exchange(other.limiter_, nullptr);
    robot_ = std::move(other.robot_);
  }
  return *this;
}

void StreamLimiter::Slot::Leave() {
  if (StreamLimiter* const limiter = std::exchange(limiter_, nullptr)) {
    limiter->Leave(robot_);
  }
}

absl::StatusOr<StreamLimiter::Slot> StreamLimiter::Enter(const std::string& robot) {
  const MutexLock lock(mutex_);
  if (max_all_ > 0 && open_ >= max_all_) {
    return WithReason(absl::ResourceExhaustedError(
                          absl::StrCat(open_, " streams are open; max-streams is ", max_all_)),
                      {"STREAMS", {}});
  }
  const auto found = of_robot_.find(robot);
  const int of_robot = found == of_robot_.end() ? 0 : found->second;
  if (open_ >= max_all_ - max_all_ / kKeptPart && max_all_ > 0 && of_robot >= kFewStreams) {
    return WithReason(
        absl::ResourceExhaustedError(absl::StrCat(
            robot, " has ", of_robot, " open streams; the last quarter of max-streams, ", max_all_,
            ", is for robots with fewer than ", kFewStreams)),
        {"STREAMS", {}});
  }
  if (max_robot_ > 0 && of_robot >= max_robot_) {
    return WithReason(
        absl::ResourceExhaustedError(absl::StrCat(
            robot, " has ", of_robot, " open streams; max-robot-streams is ", max_robot_)),
        {"ROBOT_STREAMS", {}});
  }
  ++open_;
  if (!robot.empty()) {
    ++of_robot_[robot];
  }
  return Slot(this, robot);
}

void StreamLimiter::Leave(const std::string& robot) {
  const MutexLock lock(mutex_);
  --open_;
  const auto found = of_robot_.find(robot);
  if (found != of_robot_.end() && --found->second <= 0) {
    of_robot_.erase(found);
  }
}

int StreamLimiter::open() const {
  const MutexLock lock(mutex_);
  return open_;
}

}  // namespace homing::server
