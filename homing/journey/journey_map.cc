#include "homing/journey/journey_map.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {
namespace {

// Paper III: two a camera.
constexpr int kMostFingerprintsPerSide = 2;

constexpr double kMaxSpread = 1e9;

absl::Status CheckValues(const RecordedFingerprint& recorded) {
  const Fingerprint& f = recorded.fingerprint;
  const auto field = [&](const char* name) {
    return absl::StrCat(name, " of landmark ", f.landmark);
  };
  if (f.count <= 0) {
    return MustBe(field("count"), f.count, "at least 1");
  }
  if (!std::isfinite(f.x) || !std::isfinite(f.y)) {
    return MustBe(field("mean"), absl::StrCat("(", f.x, ", ", f.y, ")"), "finite");
  }
  return CheckRange(field("spread"), recorded.spread, 0.0, kMaxSpread);
}

}  // namespace

absl::Status CheckFingerprints(const JourneyStep& step) {
  std::array<int, 2> on_side{};
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    if (recorded.side == Side::kLeft && on_side[1] > 0) {
      return FieldError("fingerprints",
                        absl::StrCat("of step ", step.step, " must have left before right"));
    }
    if (++on_side[static_cast<std::size_t>(recorded.side)] > kMostFingerprintsPerSide) {
      return FieldError("fingerprints", absl::StrCat("of step ", step.step, " must be at most ",
                                                     kMostFingerprintsPerSide, " on one side"));
    }
    HOMING_RETURN_IF_ERROR(CheckValues(recorded));
  }
  return absl::OkStatus();
}

absl::Status CheckStepSequence(const JourneyStep& step, std::int64_t least) {
  const bool is_in_order = step.sequence == kNextSequence || step.sequence >= least;
  if (is_in_order && step.sequence <= kMostSequence) {
    return absl::OkStatus();
  }
  return MustBe(
      absl::StrCat("sequence of step ", step.step), step.sequence,
      is_in_order ? absl::StrCat("at most ", kMostSequence) : absl::StrCat("at least ", least));
}

absl::Status JourneyMap::CheckLandmark(const JourneyStep& step, std::size_t index,
                                       std::size_t known) const {
  const RecordedFingerprint& recorded = step.fingerprints[index];
  const std::int32_t landmark = recorded.fingerprint.landmark;
  if (landmark < 0 || static_cast<std::size_t>(landmark) > known) {
    return MustBe("landmark", landmark, absl::StrCat("in [0, ", known, "], known or next"));
  }
  for (std::size_t i = 0; i < index; ++i) {
    if (step.fingerprints[i].fingerprint.landmark == landmark) {
      return FieldError("landmark", absl::StrCat(landmark, " appears twice in step ", step.step));
    }
  }
  const auto number = static_cast<std::size_t>(landmark);
  if (number < landmarks_.size() && landmarks_[number].side != recorded.side) {
    return FieldError(absl::StrCat("side of landmark ", landmark),
                      absl::StrCat("must be the side where it was met, in step ", step.step));
  }
  return absl::OkStatus();
}

std::int64_t JourneyMap::NextSequence() const {
  return sequences_.empty() ? 1 : sequences_.back() + 1;
}

// The steps in between have sequences too.
absl::Status JourneyMap::CheckSequence(const JourneyStep& step) const {
  const std::int64_t first = sequences_.empty() ? 0 : NextSequence();
  return CheckStepSequence(step, first + step.step - step_count());
}

absl::Status JourneyMap::Check(const JourneyStep& step) const {
  HOMING_RETURN_IF_ERROR(CheckRange("step", step.step, step_count(), kMostSteps - 1));
  HOMING_RETURN_IF_ERROR(CheckSequence(step));
  HOMING_RETURN_IF_ERROR(CheckFingerprints(step));
  std::size_t known = landmarks_.size();
  for (std::size_t i = 0; i < step.fingerprints.size(); ++i) {
    HOMING_RETURN_IF_ERROR(CheckLandmark(step, i, known));
    if (static_cast<std::size_t>(step.fingerprints[i].fingerprint.landmark) == known) {
      ++known;
    }
  }
  return absl::OkStatus();
}

void JourneyMap::CountIn(std::int64_t step, const RecordedFingerprint& recorded) {
  const auto number = static_cast<std::size_t>(recorded.fingerprint.landmark);
  if (number == landmarks_.size()) {
    landmarks_.push_back({.side = recorded.side, .first_step = step});
  }
  Landmark& landmark = landmarks_[number];
  landmark.last_step = step;
  ++landmark.fingerprint_count;
  // A running mean: recording resumes exactly from the stored value.
  landmark.spread += (recorded.spread - landmark.spread) / landmark.fingerprint_count;
}

absl::Status JourneyMap::Append(const JourneyStep& step) {
  HOMING_RETURN_IF_ERROR(Check(step));
  const auto before = static_cast<std::size_t>(step_count());
  ExtendTo(step.step + 1);
  if (step.sequence != kNextSequence) {
    // The steps in between, which have no row in the store, come right before it.
    std::int64_t sequence = step.sequence;
    for (std::size_t i = sequences_.size(); i-- > before;) sequences_[i] = sequence--;
  }
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    CountIn(step.step, recorded);
    fingerprints_.push_back(recorded.fingerprint);
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (const auto& profile = step.profiles[static_cast<std::size_t>(side)]) {
      set_profile(step.step, side, *profile);
    }
  }
  return absl::OkStatus();
}

void JourneyMap::ExtendTo(std::int64_t step_count) {
  if (step_count > this->step_count()) {
    while (static_cast<std::int64_t>(sequences_.size()) < step_count) {
      sequences_.push_back(NextSequence());
    }
    step_begin_.resize(static_cast<std::size_t>(step_count),
                       static_cast<std::int64_t>(fingerprints_.size()));
    for (std::vector<FlowProfile>& profiles : profiles_) {
      if (!profiles.empty()) profiles.resize(step_begin_.size());
    }
  }
}

std::int64_t JourneyMap::step_of(const Fingerprint& f) const {
  const auto after = std::ranges::upper_bound(step_begin_, &f - fingerprints_.data());
  return after - step_begin_.begin() - 1;
}

void JourneyMap::set_profile(std::int64_t step, Side side, const FlowProfile& profile) {
  if (profile == FlowProfile{}) {
    return;
  }
  std::vector<FlowProfile>& profiles = profiles_[static_cast<std::size_t>(side)];
  profiles.resize(step_begin_.size());
  profiles[static_cast<std::size_t>(step)] = profile;
}

}  // namespace homing
