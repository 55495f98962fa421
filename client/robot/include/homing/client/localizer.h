// Localises a robot on the way home along recorded journeys.
#ifndef HOMING_CLIENT_LOCALIZER_H_
#define HOMING_CLIENT_LOCALIZER_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "homing/client/observation.h"
#include "homing/client/server.h"
#include "homing/client/status.h"

namespace homing::robot {

// kReturn: the robot heads the other way, so its cameras have changed sides of the route.
enum class Travel { kReturn, kSame };
enum class Outcome { kMatch, kAmbiguous, kUnknownPlace };
enum class Direction { kUnknown, kHomeward, kOutward };

// A stored landmark that is similar to one seen now.
struct Match {
  std::string journey = "";
  int landmark = 0;
  std::int64_t step = 0;
  Side side = Side::kUnknown;
  // Distance of the two fingerprints, pixels.
  double delta = 0;
  // Similarity without and with the numbers of vectors, 0 to 1.
  double p = 0;
  double p_t = 0;
};

struct Answer {
  // Number of the observation, from 0.
  std::int64_t sequence = 0;
  Outcome outcome = Outcome::kUnknownPlace;
  Motion motion = Motion::kUnknown;
  // The journey and the most probable step, counted from home. Unset where there is none.
  std::optional<std::string> journey = {};
  std::optional<std::int64_t> step = {};
  // Probability of the steps first_step to last_step, inclusive.
  double probability = 0;
  std::int64_t first_step = 0;
  std::int64_t last_step = 0;
  // 0 at the far end, 1 at home.
  std::optional<double> progress_home = {};
  Direction direction = Direction::kUnknown;
  // Steps of the journey an observation; negative towards home. Unset before the robot has moved.
  std::optional<double> speed_ratio = {};
  // Change of the heading relative to the outbound path, to the robot's left: radians if the focal
  // length is known, else pixels. Unset without two cameras.
  std::optional<double> turn = {};
  // Metres to the robot's left of the outbound path divided by the distance of the seen objects.
  // Unset without two cameras.
  std::optional<double> path_offset = {};
  // 1 - the probability of being off every covered route; at least `probability`.
  double on_route = 0;
  // The best match at the believed step.
  std::optional<int> landmark = {};
  std::optional<double> similarity = {};
  std::vector<Match> matches = {};
};

struct LocalizerOptions {
  // "robots/ROBOT/journeys/JOURNEY"; either name may be "-" for all.
  std::string journey = "";
  Travel travel = Travel::kReturn;
  std::optional<Camera> left_camera = {};
  std::optional<Camera> right_camera = {};
  // Half width of the interval, steps.
  int tolerance_steps = 10;
  int max_matches = 10;
  // Least P_T of a match.
  double threshold = 0.20;
  // Messages for the user about the link, on another thread.
  std::function<void(const std::string&)> on_message = {};
};

// One drive. The link is restored by itself; recent observations are then sent again, so that the
// belief survives. Not thread-safe.
class Localizer {
 public:
  // Does not wait for the server. INVALID_ARGUMENT.
  static Result<std::unique_ptr<Localizer>> Open(const Server& server,
                                                 const LocalizerOptions& options);
  ~Localizer();

  // Sends one observation and waits for its answer. DEADLINE_EXCEEDED: none within `timeout`; the
  // observation still counts when the link is back. RESOURCE_EXHAUSTED: 64 observations wait
  // already. Other errors end the drive.
  Result<Answer> Localize(const Observation& observation, std::chrono::milliseconds timeout);

 private:
  class State;
  explicit Localizer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace homing::robot

#endif  // HOMING_CLIENT_LOCALIZER_H_
