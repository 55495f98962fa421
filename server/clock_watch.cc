#include "server/clock_watch.h"

#include <algorithm>
#include <limits>

namespace homing::server {
namespace {

// Corrections of a working clock are smaller than this.
constexpr std::chrono::minutes kJump{10};
// Within this time of its start a machine corrects its clock, if it can. A clock that came back
// from a jump must be steady for as long.
constexpr std::chrono::minutes kSettling{10};

}  // namespace

std::int64_t ClockWatch::TrustedSince(std::int64_t wall_ns,
                                      std::chrono::steady_clock::time_point steady) {
  const std::chrono::nanoseconds offset =
      std::chrono::nanoseconds(wall_ns) - steady.time_since_epoch();
  if (!begun_) started_ = steady;
  if (begun_ && offset - offset_ > kJump) {
    jumps_.push_back({offset_, since_ns_});
    since_ns_ = std::max(since_ns_, wall_ns);
  }
  while (!jumps_.empty() && offset - jumps_.back().offset <= kJump) {
    since_ns_ = jumps_.back().since_ns;
    jumps_.pop_back();
    started_ = steady;
  }
  begun_ = true;
  offset_ = offset;
  return steady - started_ < kSettling ? std::numeric_limits<std::int64_t>::max() : since_ns_;
}

}  // namespace homing::server
