// How the Pilot searches for its place; pilot.cc decides when.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/pilot/pilot.h"

namespace homing::client {
namespace {

// A search first goes back to where the pilot was last sure, but no further than kMostBackM. Then
// it sweeps kSweepM back and twice as far ahead, then further, at most kMostSweepM: blind, it would
// leave the path. It swings the heading by kSweepHeading, rad, over kSweepPeriodM. Metres.
constexpr double kMostBackM = 8;
constexpr double kSweepM = 1.5;
constexpr double kMostSweepM = 3;
constexpr double kSweepHeading = 0.2;
constexpr double kSweepPeriodM = 6;
// A robot that is lost again before it was sure for this distance, m, begins its next search with a
// longer sweep.
constexpr double kSureM = 5;

}  // namespace

// A search soon after another one sweeps further, to pass the place that stopped the last one.
void Pilot::BeginSearch() {
  sweep_m_ = sure_m_ < kSureM ? std::clamp(2 * sweep_m_, kSweepM, kMostSweepM) : kSweepM;
  sure_m_ = 0;
  searched_m_ = 0;
  back_m_ = std::min(unsure_m_, kMostBackM);
}

// After the way back, the ends lie two sweeps ahead of the start, one behind, four ahead, and so
// on.
bool Pilot::SweepsBack() const {
  if (searched_m_ < back_m_) return true;
  double sweep = sweep_m_;
  double leg = back_m_ + 2 * sweep;
  bool is_back = false;
  for (double left = searched_m_ - back_m_; left >= leg; is_back = !is_back) {
    left -= leg;
    const double behind = sweep;
    if (is_back) sweep = std::min(2 * sweep, kMostSweepM);
    leg = behind + 2 * sweep;
  }
  return is_back;
}

// Drives to and fro along the path as dead reckoning continues it, with a heading that swings: at
// some point it is that of the path.
PilotCommand Pilot::Search() const {
  const double ahead = SweepsBack() ? -Ahead() : Ahead();
  const double swing = kSweepHeading * std::sin(2 * std::numbers::pi * searched_m_ / kSweepPeriodM);
  const double wanted = std::clamp(swing - ahead * options_.heading_per_m * now_.offset_m,
                                   -options_.most_heading, options_.most_heading);
  const double rate = options_.turn_gain * (wanted - now_.heading);
  const double speed = options_.search_speed * options_.most_speed_mps;
  return {ahead * speed, std::clamp(rate, -MostTurnRate(), MostTurnRate())};
}

}  // namespace homing::client
