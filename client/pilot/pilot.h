// Drives a robot home along its outbound path by the answers of Localize: answers in, speed and
// turn rate out. Obstacles are the robot's own business. docs/how-to-steer.md
// says how to tune it for a robot.
#ifndef CLIENT_PILOT_PILOT_H_
#define CLIENT_PILOT_PILOT_H_

#include <cstdint>
#include <deque>
#include <optional>

namespace homing::client {

// What one answer of Localize says, in the robot's own left and right.
struct PilotAnswer {
  enum class Outcome { kMatch, kAmbiguous, kUnknownPlace };
  // Of the observation, from 0 without gaps; not all of them need to arrive.
  std::int64_t sequence = 0;
  // The robot's clock when the observation was made, s.
  double time_s = 0;
  Outcome outcome = Outcome::kAmbiguous;
  // Turned on the spot.
  bool is_turning = false;
  // Nothing has moved enough since the reference frame: a later answer reports the turn.
  bool is_standing = false;
  double probability = 0;
  // Way home, 0 at the far end, 1 at home.
  std::optional<double> progress_home;
  // Steps an observation, negative towards home.
  std::optional<double> speed_ratio;
  // Rad to the left since the last answer that had one, beyond what the path needs.
  std::optional<double> turn;
  // Metres left of the path over the distance of what is seen.
  std::optional<double> path_offset;
};

// Speed ahead, m/s, and turn rate to the left, rad/s.
struct PilotCommand {
  double speed_mps = 0;
  double turn_rate = 0;
};

struct PilotOptions {
  // Turns round first, and drives home ahead (Localize with travel RETURN); else drives home in
  // reverse (SAME).
  bool turn_round = true;
  // Of the outbound path, m. Above 0.
  double route_m = 60;
  // Limits. Above 0.
  double most_speed_mps = 1;
  double most_turn_rate = 0.7;
  // How far away is what the cameras see, m: turns `path_offset` into metres. Above 0.
  double distance_m = 5;
  // Rad of heading back to the path for each metre beside it, and the most of it.
  double heading_per_m = 0.35;
  double most_heading = 0.4;
  // Turn rate for each rad of heading error, 1/s.
  double turn_gain = 1.3;
  // Delay of the robot's actuators, s: a first-order lag.
  double lag_s = 0.2;
  // Share of the commanded motion that is usually lost to slip.
  double usual_slip = 0.1;
  // Speed while unsure and while searching, share of the most.
  double unsure_speed = 0.5;
  double search_speed = 0.3;
  // Unsure for so many metres driven, by the commands and the turns: searches.
  double patience_m = 25;
  // No answer for so long: slows down, stops. s.
  double slow_after_s = 0.6;
  double stop_after_s = 1.2;
  // Stops this far before home, m.
  double stop_before_m = 0.15;
};

// Call Take as answers arrive, and Drive at a steady rate of at least 10 Hz. Times are the robot's
// clock. Not thread-safe.
class Pilot {
 public:
  enum class State { kTurningRound, kDriving, kSearching, kWaiting, kHome };

  explicit Pilot(const PilotOptions& options);

  // Answers arrive in order; some may be lost.
  void Take(const PilotAnswer& answer);
  // The command until the next call.
  PilotCommand Drive(double now_s);

  State state() const { return state_; }
  // What the pilot believes now: metres left of the path, and heading against it, rad.
  double offset_m() const { return now_.offset_m; }
  double heading() const { return now_.heading; }
  double remaining_m() const { return now_.remaining_m; }

 private:
  struct Belief {
    double offset_m = 0;
    double heading = 0;
    double remaining_m = 0;
  };
  // What was commanded from a time on, and what the actuators then did.
  struct Past {
    double time_s = 0;
    double speed_mps = 0;
    double turn_rate = 0;
  };

  // Turned and driven between two times, as the commands say.
  double Turned(double from_s, double to_s) const;
  // The belief of time `from_s` carried on.
  Belief Carried(const Belief& belief, double from_s, double to_s) const;
  void TakeTurn(const PilotAnswer& answer);
  void Watch(const PilotAnswer& answer, const Belief& expected);
  void TakePlace(const PilotAnswer& answer);
  // The answer's place, `ahead_m` nearer to home than the pilot believes, is not where the robot
  // can have come to.
  bool IsElsewhere(const PilotAnswer& answer, double ahead_m);
  PilotCommand TurnRound();
  PilotCommand FollowPath(double speed_mps) const;
  void BeginSearch();
  bool SweepsBack() const;
  PilotCommand Search() const;
  double SpeedFor(double now_s) const;
  // +1 driving ahead, -1 in reverse.
  double Ahead() const { return options_.turn_round ? 1 : -1; }

  PilotOptions options_;
  State state_;
  // Of the last answer, at its time.
  Belief known_;
  // Now.
  Belief now_;
  double answer_time_s_ = 0;
  // Of the last answer that had a turn.
  double turn_time_s_ = 0;
  // When it had turned round.
  double round_s_ = 0;
  std::int64_t last_sequence_ = -1;
  // When an answer arrived; below 0: never.
  double heard_s_ = -1;
  double last_drive_s_ = -1;
  bool is_sure_ = false;
  // Answers that are sure of another place: how far ahead of the believed one it was at first, and
  // what was left of the way then, m.
  std::optional<double> elsewhere_ahead_m_;
  double elsewhere_from_m_ = 0;
  // Driven since the pilot was last sure, m.
  double unsure_m_ = 0;
  double searched_m_ = 0;
  // Driven while sure since the last search began, m.
  double sure_m_ = 0;
  // First sweep of this search, m.
  double sweep_m_ = 0;
  // Metres left of the path as the heading has them, held near what the answers say.
  double watched_m_ = 0;
  bool is_watching_ = false;
  // Turn rate that nobody commanded: slip, and the path's own bends.
  double drift_ = 0;
  // What the actuators do now.
  PilotCommand motion_;
  std::deque<Past> past_;
};

}  // namespace homing::client

#endif  // CLIENT_PILOT_PILOT_H_
