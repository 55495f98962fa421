#include "client/source/frame_pairing.h"

#include <algorithm>
#include <cstdlib>

namespace homing::client {
namespace {

constexpr std::int64_t kNone = -1;
constexpr std::int64_t kHoleNs = 500'000'000;
constexpr std::int64_t kHoleIntervals = 5;

std::int64_t MedianInterval(const std::vector<std::int64_t>& values) {
  if (values.size() < 2) return 0;
  std::vector<std::int64_t> intervals;
  intervals.reserve(values.size() - 1);
  for (std::size_t i = 1; i < values.size(); ++i) intervals.push_back(values[i] - values[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

// Merges two ascending lists; values at most `tolerance` apart make one instant, the nearest two
// first.
FramePairing Merge(const std::vector<std::int64_t>& left, const std::vector<std::int64_t>& right,
                   std::int64_t tolerance) {
  FramePairing pairing;
  std::size_t i = 0;
  std::size_t j = 0;
  const auto add = [&](bool from_left, bool from_right) {
    pairing.instants.push_back({from_left ? static_cast<std::int64_t>(i++) : kNone,
                                from_right ? static_cast<std::int64_t>(j++) : kNone});
    if (!from_right) ++pairing.alone[0];
    if (!from_left) ++pairing.alone[1];
  };
  while (i < left.size() || j < right.size()) {
    if (i == left.size() || j == right.size()) {
      add(i < left.size(), j < right.size());
      continue;
    }
    const std::int64_t distance = std::abs(left[i] - right[j]);
    const bool nearer_left = i + 1 < left.size() && std::abs(left[i + 1] - right[j]) < distance;
    const bool nearer_right = j + 1 < right.size() && std::abs(left[i] - right[j + 1]) < distance;
    if (distance <= tolerance && !nearer_left && !nearer_right) {
      add(true, true);
    } else {
      add(left[i] < right[j], right[j] <= left[i]);
    }
  }
  return pairing;
}

bool Useful(const FramePairing& pairing, std::size_t left, std::size_t right) {
  const std::size_t pairs = left - static_cast<std::size_t>(pairing.alone[0]);
  return 2 * pairs >= std::min(left, right);
}

FramePairing InOrder(std::int64_t left_size, std::int64_t right_size) {
  FramePairing pairing;
  for (std::int64_t i = 0; i < std::max(left_size, right_size); ++i) {
    pairing.instants.push_back({i < left_size ? i : kNone, i < right_size ? i : kNone});
  }
  pairing.alone = {std::max<std::int64_t>(left_size - right_size, 0),
                   std::max<std::int64_t>(right_size - left_size, 0)};
  pairing.by = "order";
  return pairing;
}

}  // namespace

FramePairing PairFrames(const FrameKeys& left, std::int64_t left_size, const FrameKeys& right,
                        std::int64_t right_size) {
  if (left.kind != right.kind || left.kind == FrameKeys::Kind::kOrder) {
    return InOrder(left_size, right_size);
  }
  const bool time = left.kind == FrameKeys::Kind::kTime;
  const std::int64_t tolerance =
      time ? std::min(MedianInterval(left.values), MedianInterval(right.values)) / 2 : 0;
  FramePairing pairing = Merge(left.values, right.values, tolerance);
  if (!Useful(pairing, left.values.size(), right.values.size())) {
    return InOrder(left_size, right_size);
  }
  pairing.by = time ? "time" : "number";
  return pairing;
}

std::vector<std::int64_t> FindHoles(const FrameKeys& keys) {
  std::vector<std::int64_t> holes;
  if (keys.kind != FrameKeys::Kind::kTime) return holes;
  const std::int64_t usual = MedianInterval(keys.values);
  for (std::size_t i = 1; i < keys.values.size(); ++i) {
    const std::int64_t interval = keys.values[i] - keys.values[i - 1];
    if (interval > kHoleNs && interval / kHoleIntervals > usual) {
      holes.push_back(static_cast<std::int64_t>(i));
    }
  }
  return holes;
}

}  // namespace homing::client
