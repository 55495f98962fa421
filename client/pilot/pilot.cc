#include "client/pilot/pilot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace homing::client {
namespace {

// Commands are kept for this long, s.
constexpr double kMemoryS = 10;
// Time constant of the drift, s, and its bound, rad/s.
constexpr double kDriftS = 1.0;
constexpr double kMostDrift = 0.3;
// The robot has turned round when the heading error is below kTurnedRound, rad; below kTurnSlowly
// it turns more slowly.
constexpr double kTurnedRound = 0.05;
constexpr double kTurnSlowly = 0.5;
// How fast the offsets correct the heading, 1/m.
constexpr double kHeadingGain = 0.25;
// Turn between two observations that the flow still shows, rad. A faster turn moves near objects
// further than they can be tracked.
constexpr double kMostTurnPerView = 0.08;
constexpr double kLeastSpeedMps = 0.15;
// Greatest speed near home, m/s for each metre left.
constexpr double kSpeedPerM = 0.5;
// The last part of the way, m, is driven by the commands: an answer is no better than its
// tolerance, and the map ends. An answer then corrects the distance only by a fraction of the
// difference.
constexpr double kCloseM = 1.5;
constexpr double kCloseGain = 0.03;
// An answer may place the robot more than kJumpM, plus kJumpPerM of the way driven unsure, from the
// expected place. The pilot believes such a place after kJumpConfirmedM of driving. Metres.
constexpr double kJumpM = 3;
constexpr double kJumpPerM = 0.1;
constexpr double kJumpConfirmedM = 4;
// An answer agrees with the pilot if it has at least this probability and its place is at most this
// far from the expected one, m.
constexpr double kAgreeProbability = 0.5;
constexpr double kAgreeM = 2;
// An answer is no better than its tolerance: the pilot accepts its place over this distance, m.
constexpr double kPlaceM = 2;
// A heading that is wrong by some angle takes the robot beside the path by the angle times the way.
// The pilot starts within 10 degrees: kFirstPatienceM take it 0.7 m. After d m of the way on which
// it was sure, offsets within 0.3 m show the heading to 0.3 m / d: kPatiencePerM * d take it 0.6 m.
constexpr double kFirstPatienceM = 4;
constexpr double kPatiencePerM = 2;
// Past objects that are 500 m away, one metre moves the image by a step. So a robot that drove
// kBlindM without one is held fast, or its cameras are covered or frozen. Metres.
constexpr double kBlindM = 1;
}  // namespace

Pilot::Pilot(const PilotOptions& options)
    : options_(options),
      state_(options.turn_round ? State::kTurningRound : State::kDriving),
      patience_left_m_(std::min(kFirstPatienceM, options.patience_m)) {
  known_.remaining_m = options.route_m;
  if (options.turn_round) known_.heading = -std::numbers::pi;
  now_ = known_;
}

Pilot::Belief Pilot::Carried(const Belief& belief, double from_s, double to_s) const {
  Belief carried = belief;
  past_.Between(from_s, to_s, [&](double speed_mps, double turn_rate, double seconds) {
    const double driven = speed_mps * seconds;
    const double turned = (turn_rate + drift_) * seconds;
    carried.heading += 0.5 * turned;
    carried.offset_m += driven * std::sin(carried.heading);
    carried.remaining_m -= Ahead() * driven * std::cos(carried.heading);
    carried.heading += 0.5 * turned;
  });
  return carried;
}

void Pilot::Take(const PilotAnswer& answer) {
  if (answer.sequence <= last_sequence_) return;
  arrival_time_s_ = last_drive_s_;
  if (last_sequence_ >= 0 && answer.time_s > view_time_s_) {
    view_s_ =
        (answer.time_s - view_time_s_) / static_cast<double>(answer.sequence - last_sequence_);
  }
  view_time_s_ = answer.time_s;
  if (!answer.is_standing) blind_m_ = 0;
  TakeTurn(answer);
  TakePlace(answer);
  last_sequence_ = answer.sequence;
  answer_time_s_ = std::max(round_s_, answer.time_s);
}

// The turns add up to the heading. Those of answers that were lost, and those that nothing showed,
// are taken from the commands.
void Pilot::TakeTurn(const PilotAnswer& answer) {
  const double since_s = answer.time_s - answer_time_s_;
  const auto observations = static_cast<double>(answer.sequence - last_sequence_);
  if (last_sequence_ >= 0 && observations > 1) {
    known_.heading += (past_.Turned(answer_time_s_, answer.time_s) + drift_ * since_s) *
                      (observations - 1) / observations;
  }
  if (answer.time_s < round_s_) return;
  if (!answer.turn) {
    if (observations == 1 && (!answer.is_standing || blind_m_ > kBlindM)) {
      known_.heading += past_.Turned(answer_time_s_, answer.time_s) + drift_ * since_s;
    }
    return;
  }
  known_.heading += *answer.turn;
  const double since_turn_s = answer.time_s - turn_time_s_;
  if (last_sequence_ >= 0 && observations == 1 && since_turn_s > 0 && since_turn_s < 1 &&
      state_ == State::kDriving) {
    const double drift = (*answer.turn - past_.Turned(turn_time_s_, answer.time_s)) / since_turn_s;
    drift_ += (1 - std::exp(-since_turn_s / kDriftS)) *
              (std::clamp(drift, -2 * kMostDrift, 2 * kMostDrift) - drift_);
    drift_ = std::clamp(drift_, -kMostDrift, kMostDrift);
  }
  turn_time_s_ = answer.time_s;
}

void Pilot::TakePlace(const PilotAnswer& answer) {
  const Belief expected = Carried(known_, answer_time_s_, answer.time_s);
  is_sure_ = answer.outcome == PilotAnswer::Outcome::kMatch;
  if (state_ == State::kTurningRound || answer.time_s < round_s_) return;
  const double answered_m =
      answer.progress_home ? (1 - *answer.progress_home) * options_.route_m : expected.remaining_m;
  const bool is_elsewhere =
      blind_m_ > kBlindM || IsElsewhere(answer, expected.remaining_m - answered_m);
  is_sure_ = is_sure_ && !is_elsewhere;
  agrees_ = answer.progress_home && blind_m_ <= kBlindM &&
            answer.probability >= kAgreeProbability &&
            std::abs(expected.remaining_m - answered_m) < kAgreeM;
  PilotAnswer here = answer;
  if (is_elsewhere) here.path_offset.reset();
  CorrectHeading(here, expected);
  known_.offset_m = here.path_offset ? *here.path_offset * options_.distance_m : expected.offset_m;
  const double before_m = std::exchange(known_.remaining_m, expected.remaining_m);
  if (!answer.progress_home || !is_sure_) return;
  const double off_m = answered_m - expected.remaining_m;
  const bool is_close = answered_m < kCloseM && std::abs(off_m) < kCloseM;
  const double driven_m = std::abs(before_m - expected.remaining_m);
  const double gain = is_close ? kCloseGain : 1 - std::exp(-driven_m / kPlaceM);
  known_.remaining_m += (std::abs(off_m) < kJumpM ? gain : 1) * off_m;
}

// A place far from the robot's last place is believed once the answers have repeated it for a while
// and it has moved as far as the robot has driven. Until then the pilot dead-reckons, and ignores
// the offset that belongs to that place.
bool Pilot::IsElsewhere(const PilotAnswer& answer, double ahead_m) {
  if (!answer.progress_home || state_ == State::kSearching ||
      std::abs(ahead_m) < kJumpM + kJumpPerM * unsure_m_) {
    elsewhere_ahead_m_.reset();
    return false;
  }
  if (!is_sure_) return true;
  if (!elsewhere_ahead_m_ || std::abs(ahead_m - *elsewhere_ahead_m_) > kJumpM) {
    elsewhere_ahead_m_ = ahead_m;
    elsewhere_from_m_ = known_.remaining_m;
  }
  return elsewhere_from_m_ - known_.remaining_m < kJumpConfirmedM;
}

// Integrates the heading to an offset, and compares it with the answered offsets. If the two drift
// apart, turns were lost, and the heading is wrong.
void Pilot::CorrectHeading(const PilotAnswer& answer, const Belief& expected) {
  if (!answer.path_offset) {
    is_integrating_ = false;
    return;
  }
  const double offset_m = *answer.path_offset * options_.distance_m;
  if (!is_integrating_) integrated_m_ = offset_m;
  is_integrating_ = true;
  integrated_m_ += expected.offset_m - known_.offset_m;
  // Signed: in reverse a heading moves the robot the other way.
  const double driven_m = Ahead() * (known_.remaining_m - expected.remaining_m);
  const double off_m = offset_m - integrated_m_;
  integrated_m_ += 2 * kHeadingGain * std::abs(driven_m) * off_m;
  known_.heading += kHeadingGain * kHeadingGain * driven_m * off_m;
}

PilotCommand Pilot::Drive(double now_s) {
  const double dt = last_drive_s_ < 0 ? 0 : now_s - last_drive_s_;
  last_drive_s_ = now_s;
  if (arrival_time_s_ < 0) arrival_time_s_ = now_s;
  now_ = Carried(known_, answer_time_s_, now_s);
  const double driven = std::abs(motion_.speed_mps) * dt;
  unsure_m_ = is_sure_ ? 0 : unsure_m_ + driven;
  sure_m_ += is_sure_ ? driven : 0;
  blind_m_ += driven;
  if (blind_m_ > kBlindM) patience_left_m_ = std::min(patience_left_m_, kFirstPatienceM);
  if (state_ != State::kTurningRound) {
    const double per_m = is_sure_ ? kPatiencePerM : agrees_ ? 0 : -1;
    patience_left_m_ = std::clamp(patience_left_m_ + per_m * driven, 0.0, options_.patience_m);
  }
  const bool is_patient = is_sure_ || agrees_ || patience_left_m_ > 0;
  PilotCommand command;
  if (state_ == State::kTurningRound) {
    command = TurnRound();
  } else if (state_ != State::kHome) {
    // What is older than the commands kept says nothing about now.
    const bool is_late =
        now_s - arrival_time_s_ > options_.stop_after_s || now_s - answer_time_s_ > kMemoryS;
    if (is_patient && now_.remaining_m <= options_.stop_before_m) {
      state_ = State::kHome;
    } else if (is_late) {
      state_ = State::kWaiting;
    } else if (!is_patient) {
      if (state_ != State::kSearching) BeginSearch();
      state_ = State::kSearching;
      searched_m_ += driven;
      command = Search();
    } else {
      state_ = State::kDriving;
      command = FollowPath(SpeedFor(now_s));
    }
  }
  // Predicts the motion until the next call.
  const double share = options_.lag_s > 0 ? 1 - std::exp(-dt / options_.lag_s) : 1;
  const double kept = 1 - options_.usual_slip;
  motion_.speed_mps += share * (kept * command.speed_mps - motion_.speed_mps);
  motion_.turn_rate += share * (kept * command.turn_rate - motion_.turn_rate);
  past_.Add(now_s, motion_.speed_mps, motion_.turn_rate, kMemoryS);
  return command;
}

PilotCommand Pilot::TurnRound() {
  if (std::abs(now_.heading) < kTurnedRound) {
    // The next answers report the heading error that remains.
    state_ = State::kDriving;
    round_s_ = last_drive_s_;
    turn_time_s_ = answer_time_s_ = last_drive_s_;
    known_ = {.offset_m = 0, .heading = 0, .remaining_m = options_.route_m};
    now_ = known_;
    return {};
  }
  const double rate = now_.heading < 0 ? MostTurnRate() : -MostTurnRate();
  return {0, std::abs(now_.heading) > kTurnSlowly ? rate : 0.4 * rate};
}

double Pilot::MostTurnRate() const {
  return std::min(options_.most_turn_rate, kMostTurnPerView / view_s_);
}

double Pilot::SpeedFor(double now_s) const {
  double speed = options_.most_speed_mps;
  if (!is_sure_ || now_s - arrival_time_s_ > options_.slow_after_s) speed *= options_.unsure_speed;
  speed = std::min(speed, kSpeedPerM * std::max(0.0, now_.remaining_m));
  return std::max(kLeastSpeedMps, speed * std::cos(std::min(1.2, 2 * std::abs(now_.heading))));
}

// Heads back to the path, at an angle that grows with the offset; in reverse the other way.
PilotCommand Pilot::FollowPath(double speed_mps) const {
  const double wanted = std::clamp(-Ahead() * options_.heading_per_m * now_.offset_m,
                                   -options_.most_heading, options_.most_heading);
  const double rate = options_.turn_gain * (wanted - now_.heading) - drift_;
  return {Ahead() * speed_mps, std::clamp(rate, -MostTurnRate(), MostTurnRate())};
}

}  // namespace homing::client
