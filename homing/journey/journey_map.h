// The topological map of one journey: fingerprints by step and side, landmarks in the order met
// (paper III). No image is in it.
#ifndef HOMING_JOURNEY_JOURNEY_MAP_H_
#define HOMING_JOURNEY_JOURNEY_MAP_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "homing/flow/motion.h"
#include "homing/flow/observation.h"
#include "homing/journey/journey_settings.h"
#include "homing/journey/measured_route.h"
#include "homing/landmark/fingerprint.h"
#include "homing/landmark/flow_profile.h"

namespace homing {

// A landmark, numbered along the journey.
struct Landmark {
  Side side = Side::kLeft;
  std::int64_t first_step = 0;
  std::int64_t last_step = 0;
  std::int32_t fingerprint_count = 0;
  // Mean over its steps of the relative spread of magnitudes.
  double spread = 0;
  friend bool operator==(const Landmark&, const Landmark&) = default;
};

// One fingerprint of one step, as recorded.
struct RecordedFingerprint {
  Side side = Side::kLeft;
  Fingerprint fingerprint;
  double spread = 0;
  friend bool operator==(const RecordedFingerprint&, const RecordedFingerprint&) = default;
};

// Stands for an unknown JourneyStep::sequence: that of the previous step plus 1; 1 for the first
// step.
inline constexpr std::int64_t kNextSequence = -1;

// One step of a journey. It has no fingerprints if the robot turned or nothing was seen.
struct JourneyStep {
  // Number of the step, from 0 at home.
  std::int64_t step = 0;
  Motion motion = Motion::kMoving;
  // Left before right, low x before high x; at most four.
  std::vector<RecordedFingerprint> fingerprints;
  // Indexed by Side of the route; empty where no camera looked.
  std::array<std::optional<FlowProfile>, 2> profiles{};
  // The frame that made the step: the observation's sequence, or for flow vectors the index of the
  // frame in the robot's source, if the client names it. Grows from step to step.
  std::int64_t sequence = kNextSequence;
  friend bool operator==(const JourneyStep&, const JourneyStep&) = default;
};

// INVALID_ARGUMENT unless the fingerprints have left before right, at most two a side, finite
// means, counts above 0 and spreads in [0, 1e9].
absl::Status CheckFingerprints(const JourneyStep& step);
// INVALID_ARGUMENT if the step has a sequence below `least`.
absl::Status CheckStepSequence(const JourneyStep& step, std::int64_t least);

// Most steps of a journey: 46 days at five observations a second. Bounds the step count that a
// damaged map claims.
inline constexpr std::int64_t kMostSteps = 20'000'000;

// Not thread-safe: its owner must lock it. Takes 16 bytes a fingerprint, 16 a step, 168 a profile.
class JourneyMap {
 public:
  JourneyMap() = default;
  explicit JourneyMap(JourneySettings settings) : settings_(std::move(settings)) {}

  // INVALID_ARGUMENT: `step` is below step_count() (steps left out are empty), a landmark that is
  // neither known nor next or twice in the step, a side unlike the landmark's, as
  // CheckFingerprints, a sequence too low for the steps in between. After an error the map is as
  // before.
  absl::Status Append(const JourneyStep& step);
  // Adds empty steps at the end until there are `step_count`. REQUIRES: step_count <= kMostSteps.
  void ExtendTo(std::int64_t step_count);

  const JourneySettings& settings() const { return settings_; }
  JourneySettings& mutable_settings() { return settings_; }
  std::int64_t step_count() const { return static_cast<std::int64_t>(step_begin_.size()); }
  // Fingerprints of one step, left side first. REQUIRES: 0 <= step < step_count().
  std::span<const Fingerprint> fingerprints(std::int64_t step) const {
    const auto index = static_cast<std::size_t>(step);
    const auto begin = static_cast<std::size_t>(step_begin_[index]);
    const auto end = index + 1 < step_begin_.size()
                         ? static_cast<std::size_t>(step_begin_[index + 1])
                         : fingerprints_.size();
    return std::span<const Fingerprint>(fingerprints_).subspan(begin, end - begin);
  }
  // JourneyStep::sequence of each step. REQUIRES: 0 <= step < step_count().
  std::int64_t sequence(std::int64_t step) const {
    return sequences_[static_cast<std::size_t>(step)];
  }
  // REQUIRES: a fingerprint of this map.
  std::int64_t step_of(const Fingerprint& f) const;
  std::span<const Fingerprint> all_fingerprints() const { return fingerprints_; }
  // The profile of each step, all 0 where a step has none; empty if no step of this side has one.
  std::span<const FlowProfile> profiles(Side side) const {
    return profiles_[static_cast<std::size_t>(side)];
  }
  // An all-zero profile counts as none. REQUIRES: 0 <= step < step_count().
  void set_profile(std::int64_t step, Side side, const FlowProfile& profile);
  // The result of MeasuredScale, shared by all readers of this map.
  MeasuredRoute& measured_route() const { return measured_route_; }
  // Indexed by landmark number.
  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  Side side_of(const Fingerprint& f) const {
    return landmarks_[static_cast<std::size_t>(f.landmark)].side;
  }

  // The mean spread of one landmark as it was stored. REQUIRES: a known landmark.
  void set_spread(std::int32_t landmark, double spread) {
    landmarks_[static_cast<std::size_t>(landmark)].spread = spread;
  }

 private:
  absl::Status Check(const JourneyStep& step) const;
  absl::Status CheckSequence(const JourneyStep& step) const;
  // The sequence of a step that is appended without one.
  std::int64_t NextSequence() const;
  // Checks the fingerprint at `index`; `known` landmarks were met before it.
  absl::Status CheckLandmark(const JourneyStep& step, std::size_t index, std::size_t known) const;
  void CountIn(std::int64_t step, const RecordedFingerprint& recorded);

  JourneySettings settings_;
  std::vector<Fingerprint> fingerprints_;
  // Index of each step's first fingerprint.
  std::vector<std::int64_t> step_begin_;
  std::vector<std::int64_t> sequences_;
  std::vector<Landmark> landmarks_;
  std::array<std::vector<FlowProfile>, 2> profiles_;
  mutable MeasuredRoute measured_route_;
};

}  // namespace homing

#endif  // HOMING_JOURNEY_JOURNEY_MAP_H_
