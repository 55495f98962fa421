#include "server/clock_watch.h"

#include <algorithm>
#include <limits>

namespace homing::server {
namespace {

// Corrections of a working clock are smaller than this.
constexpr std::chrono::minutes kJump{10};
// Within this time of its start a machine corrects its clock, if it can.
constexpr std::chrono::minutes kSettling{10};

}  // namespace

std::int64_t ClockWatch::TrustedSince(std::int64_t wall_ns,
                                      std::chrono::steady_clock::time_point steady) {
  const auto passed = std::chrono::nanoseconds(wall_ns - wall_ns_) - (steady - steady_);
  if (begun_ && passed > kJump) since_ns_ = std::max(since_ns_, wall_ns);
  if (!begun_) started_ = steady;
  begun_ = true;
  wall_ns_ = wall_ns;
  steady_ = steady;
  return steady - started_ < kSettling ? std::numeric_limits<std::int64_t>::max() : since_ns_;
}

}  // namespace homing::server
