// Drives a robot home along its outbound path by the answers of Localize: answers in, speed and
// turn rate out. The robot itself must avoid obstacles. docs/how-to-steer.md describes how to tune
// the pilot for a robot.
#ifndef CLIENT_PILOT_PILOT_H_
#define CLIENT_PILOT_PILOT_H_

#include <cstdint>
#include <optional>

#include "client/pilot/motion_history.h"

namespace homing::client {

// The content of one answer of Localize, in terms of the robot's own left and right.
struct PilotAnswer {
  enum class Outcome { kMatch, kAmbiguous, kUnknownPlace };
  // Number of the observation, from 0 without gaps; answers may be missing.
  std::int64_t sequence = 0;
  // The robot's clock when the observation was made, s.
  double time_s = 0;
  Outcome outcome = Outcome::kAmbiguous;
  // Turned on the spot.
  bool is_turning = false;
  // Nothing has moved enough since the reference frame: the place is the one before, and a later
  // answer reports the turn. If the robot drives meanwhile, it is not believed for long.
  bool is_standing = false;
  double probability = 0;
  // Progress home: 0 at the far end, 1 at home.
  std::optional<double> progress_home;
  // Steps an observation, negative towards home.
  std::optional<double> speed_ratio;
  // Change of the heading relative to the path since the last answer that had one, rad to the left.
  std::optional<double> turn;
  // Metres left of the path divided by the distance of the seen objects.
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
  // Length of the outbound path, m. Above 0.
  double route_m = 60;
  // Limits. Above 0.
  double most_speed_mps = 1;
  double most_turn_rate = 0.7;
  // Distance of the objects that the cameras see, m; converts `path_offset` to metres. Above 0.
  double distance_m = 5;
  // Heading back to the path, rad for each metre beside it, and its maximum, rad.
  double heading_per_m = 0.35;
  double most_heading = 0.4;
  // Turn rate for each rad of heading error, 1/s.
  double turn_gain = 1.3;
  // Delay of the robot's actuators, s: a first-order lag.
  double lag_s = 0.2;
  // Fraction of the commanded motion that is usually lost to slip.
  double usual_slip = 0.1;
  // Speeds while unsure and while searching, as fractions of the greatest speed.
  double unsure_speed = 0.5;
  double search_speed = 0.3;
  // Most metres driven by the commands and the turns while unsure, after which the pilot stops and
  // searches; fewer soon after the start, where the heading is not known as well. Metres on which
  // the answers agree with the pilot do not count.
  double patience_m = 25;
  // Time without an answer after which the pilot slows down, and after which it stops, s. It also
  // stops while the answers are older than 10 s.
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
  // The pilot's present belief: metres left of the path, and heading relative to it, rad.
  double offset_m() const { return now_.offset_m; }
  double heading() const { return now_.heading; }
  double remaining_m() const { return now_.remaining_m; }

 private:
  struct Belief {
    double offset_m = 0;
    double heading = 0;
    double remaining_m = 0;
  };

  // The belief of time `from_s`, advanced to `to_s`.
  Belief Carried(const Belief& belief, double from_s, double to_s) const;
  void TakeTurn(const PilotAnswer& answer);
  void CorrectHeading(const PilotAnswer& answer, const Belief& expected);
  void TakePlace(const PilotAnswer& answer);
  // True if the robot cannot have reached the answer's place, which is `ahead_m` nearer to home
  // than the pilot believes.
  bool IsElsewhere(const PilotAnswer& answer, double ahead_m);
  PilotCommand TurnRound();
  PilotCommand FollowPath(double speed_mps) const;
  void BeginSearch();
  bool SweepsBack() const;
  PilotCommand Search() const;
  double SpeedFor(double now_s) const;
  // Of the options, but no more than the observations can show.
  double MostTurnRate() const;
  // +1 driving ahead, -1 in reverse.
  double Ahead() const { return options_.turn_round ? 1 : -1; }

  PilotOptions options_;
  State state_;
  // Belief of the last answer, at its time.
  Belief known_;
  // Belief now.
  Belief now_;
  // Time at which the last answer's observation was made, s.
  double answer_time_s_ = 0;
  // Time of the last observation, and the time between two, s: five a second until it is known.
  double view_time_s_ = 0;
  double view_s_ = 0.2;
  // Time of the last answer that had a turn, s.
  double turn_time_s_ = 0;
  // Time when the robot had turned round, s.
  double round_s_ = 0;
  std::int64_t last_sequence_ = -1;
  // Time at which the last answer arrived, s; below 0: none yet.
  double arrival_time_s_ = -1;
  double last_drive_s_ = -1;
  bool is_sure_ = false;
  // The last answer, sure or not, had the place that the pilot expected.
  bool agrees_ = false;
  // While answers are sure of another place: how far ahead of the believed place it was in the
  // first of them, and how much of the way was left then, m.
  std::optional<double> elsewhere_ahead_m_;
  double elsewhere_from_m_ = 0;
  // Driven since the pilot was last sure, and how much further it may drive unsure, m.
  double unsure_m_ = 0;
  double patience_left_m_;
  double searched_m_ = 0;
  // This search first goes back so far, m.
  double back_m_ = 0;
  // Driven since the cameras last showed a motion, m.
  double blind_m_ = 0;
  // Driven while sure since the last search began, m.
  double sure_m_ = 0;
  // First sweep of this search, m.
  double sweep_m_ = 0;
  // Metres left of the path by integration of the heading, kept near the offsets of the answers.
  double integrated_m_ = 0;
  bool is_integrating_ = false;
  // Turn rate that no command caused: slip, and the path's own bends.
  double drift_ = 0;
  // The actuators' present motion.
  PilotCommand motion_;
  MotionHistory past_;
};

}  // namespace homing::client

#endif  // CLIENT_PILOT_PILOT_H_
