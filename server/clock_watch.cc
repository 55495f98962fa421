#include "server/clock_watch.h"

#include <algorithm>

namespace homing::server {
namespace {

// Corrections of a working clock are smaller than this.
constexpr std::chrono::minutes kJump{10};

}  // namespace

std::int64_t ClockWatch::TrustedSince(std::int64_t wall_ns,
                                      std::chrono::steady_clock::time_point steady) {
  const auto passed = std::chrono::nanoseconds(wall_ns - wall_ns_) - (steady - steady_);
  if (begun_ && passed > kJump) since_ns_ = std::max(since_ns_, wall_ns);
  begun_ = true;
  wall_ns_ = wall_ns;
  steady_ = steady;
  return since_ns_;
}

}  // namespace homing::server
