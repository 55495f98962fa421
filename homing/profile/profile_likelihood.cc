#include "homing/profile/profile_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace homing {
namespace {

// What a side says on a foreign route, logarithm: the best of many steps looks good.
constexpr double kFirstForeignEvidence = 0.57;
constexpr double kForeignEvidence = 0.205;
// Stored profiles that tell how far away those of other places are; at most twice as many.
constexpr std::int64_t kSamples = 256;
// A less probable offset is tried only now and then, once the place is known.
constexpr double kLeastOffset = 0.05;

bool HasProfiles(const JourneyRef& journey, std::size_t side) {
  return !journey.map->profiles(Side{static_cast<int>(side)}).empty();
}

std::vector<const FlowProfile*> SampleOf(std::span<const JourneyRef> journeys, Side side) {
  std::int64_t all = 0;
  for (const JourneyRef& journey : journeys) {
    all += std::ssize(journey.map->profiles(side));
  }
  const std::int64_t stride = std::max<std::int64_t>(1, all / kSamples);
  std::vector<const FlowProfile*> sample;
  sample.reserve(2 * kSamples);
  std::int64_t next = 0;
  for (const JourneyRef& journey : journeys) {
    const auto stored = journey.map->profiles(side);
    for (; next < std::ssize(stored); next += stride) {
      sample.push_back(&stored[static_cast<std::size_t>(next)]);
    }
    next -= std::ssize(stored);
  }
  return sample;
}

}  // namespace

ProfileLikelihood::ProfileLikelihood() : anywhere_(PathOffsets::Prior()) {
  for (std::size_t view = 0; view < kViews; ++view) {
    covered_[view] = CoveredCells(MagnificationOf(view));
  }
}

bool ProfileLikelihood::CanCompare(std::span<const JourneyRef> journeys, const SeenProfiles& seen) {
  return std::ranges::any_of(journeys, [&seen](const JourneyRef& journey) {
    return (seen[0] && HasProfiles(journey, 0)) || (seen[1] && HasProfiles(journey, 1));
  });
}

void ProfileLikelihood::Compute(std::span<const JourneyRef> journeys, const SeenProfiles& seen,
                                std::span<const StepMass> predicted) {
  offsets_.resize(journeys.size());
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    offsets_[i].Grow(journeys[i].map->step_count());
  }
  Choose(journeys, predicted);
  for (std::size_t side = 0; side < seen.size(); ++side) {
    compared_[side] =
        seen[side] && std::ranges::any_of(journeys, [side](const JourneyRef& journey) {
          return HasProfiles(journey, side);
        });
    if (compared_[side]) {
      weights_[side] = EvidenceWeight(seen[side]->size());
      Measure(journeys, Side{static_cast<int>(side)}, *seen[side], predicted);
    }
  }
  Weigh(predicted);
}

// All offsets where any step is in question, else the probable ones and one more in turn.
void ProfileLikelihood::Choose(std::span<const JourneyRef> journeys,
                               std::span<const StepMass> predicted) {
  bool all = true;
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    all = all && std::ssize(predicted[i].mass) == journeys[i].map->step_count();
  }
  const auto in_turn = static_cast<std::size_t>(instants_) % kViews;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    chosen_[offset] = all || anywhere_[offset] >= kLeastOffset || offset == in_turn;
  }
}

std::vector<ProfileLikelihood::SeenView> ProfileLikelihood::ViewsOf(
    std::size_t side, const ProfileMaker& seen) const {
  std::vector<SeenView> views;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    if (!chosen_[offset]) continue;
    const std::size_t view = ViewOf(side, offset);
    views.push_back({view, seen.Make(MagnificationOf(view))});
  }
  return views;
}

void ProfileLikelihood::Measure(std::span<const JourneyRef> journeys, Side side,
                                const ProfileMaker& seen, std::span<const StepMass> predicted) {
  const auto at = static_cast<std::size_t>(side);
  const std::vector<SeenView> views = ViewsOf(at, seen);
  // All views at once: each stored profile is read once.
  std::vector<ProfileView> compared;
  compared.reserve(views.size());
  const std::vector<const FlowProfile*> sample = SampleOf(journeys, side);
  std::vector<std::uint16_t> of_sample(views.size() * sample.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    compared.push_back({views[i].profile, covered_[views[i].view],
                        std::span(of_sample).subspan(i * sample.size(), sample.size())});
  }
  ProfileDistances(compared, std::span(sample));
  for (std::size_t i = 0; i < views.size(); ++i) {
    scales_[at][views[i].view] = ScaleOf(compared[i].distances);
    distances_[at][views[i].view].resize(journeys.size());
  }
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    auto stored = journeys[i].map->profiles(side);
    if (!stored.empty()) {
      stored =
          stored.subspan(static_cast<std::size_t>(predicted[i].first), predicted[i].mass.size());
    }
    compared.clear();
    for (const auto& [view, profile] : views) {
      std::vector<std::uint16_t>& distances = distances_[at][view][i];
      distances.resize(stored.size());
      compared.push_back({profile, covered_[view], distances});
    }
    ProfileDistances(compared, stored);
  }
}

void ProfileLikelihood::Multiply(std::size_t side, std::size_t view, std::size_t journey,
                                 std::vector<float>& factors) const {
  const std::vector<std::uint16_t>& distances = distances_[side][view][journey];
  const ProfileRatio& ratio =
      instants_ == 0 ? ProfileRatio::First() : ProfileRatio::Further(weights_[side]);
  ratio.Multiply(distances, scales_[side][view], std::span(factors).first(distances.size()));
}

float ProfileLikelihood::WeightOf(std::size_t offset, std::size_t journey,
                                  std::size_t stretch) const {
  const OffsetValues& believed = offsets_[journey].of(stretch);
  double tried = 0;
  for (std::size_t i = 0; i < kViews; ++i) {
    tried += chosen_[i] ? believed[i] : 0;
  }
  return static_cast<float>(believed[offset] / tried);
}

void ProfileLikelihood::AddOffset(std::size_t offset, std::size_t journey,
                                  const StepMass& predicted) {
  std::vector<float>& likelihoods = likelihoods_[journey];
  const auto first = static_cast<std::size_t>(predicted.first);
  constexpr auto kStretch = static_cast<std::size_t>(PathOffsets::kStretch);
  for (std::size_t i = 0; i < fits_[journey].size(); ++i) {
    const std::size_t stretch = first_stretch_[journey] + i;
    const float weight = WeightOf(offset, journey, stretch);
    const std::size_t begin = std::max(first, stretch * kStretch) - first;
    const std::size_t end = std::min(first + factors_.size(), (stretch + 1) * kStretch) - first;
    float fit = 0;
    for (std::size_t step = begin; step < end; ++step) {
      likelihoods[step] += weight * factors_[step];
      fit += predicted.mass[step] * factors_[step];
    }
    fits_[journey][i][offset] = double{fit};
    mean_fit_ += double{weight} * double{fit};
  }
}

// Each step's ratio is the mean over the offsets, as they are believed there.
void ProfileLikelihood::Weigh(std::span<const StepMass> predicted) {
  likelihoods_.resize(predicted.size());
  fits_.resize(predicted.size());
  first_stretch_.resize(predicted.size());
  mean_fit_ = 0;
  double mass = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const std::int64_t first = predicted[i].first;
    const std::int64_t end = first + std::ssize(predicted[i].mass);
    likelihoods_[i].assign(predicted[i].mass.size(), 0);
    first_stretch_[i] = static_cast<std::size_t>(first / PathOffsets::kStretch);
    fits_[i].assign(PathOffsets::StretchesOf(end) - first_stretch_[i], OffsetValues{});
    mass += predicted[i].Sum();
    for (std::size_t offset = 0; offset < kViews; ++offset) {
      if (!chosen_[offset]) continue;
      factors_.assign(predicted[i].mass.size(), 1);
      for (std::size_t side = 0; side < compared_.size(); ++side) {
        if (compared_[side]) Multiply(side, ViewOf(side, offset), i, factors_);
      }
      AddOffset(offset, i, predicted[i]);
    }
  }
  mean_fit_ /= mass;
}

double ProfileLikelihood::LogFit() const { return std::log(std::max(mean_fit_, 1e-30)) / sides(); }

double ProfileLikelihood::OffRoute() const {
  if (instants_ == 0) {
    return kFirstForeignEvidence;
  }
  double weight = 0;
  for (std::size_t side = 0; side < compared_.size(); ++side) {
    weight += compared_[side] ? static_cast<double>(weights_[side]) / kWholeWeight : 0;
  }
  return kForeignEvidence * weight / sides();
}

// An offset under which the believed steps fit gains, there.
void ProfileLikelihood::Learn() {
  OffsetValues mass{};
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    const OffsetValues of_journey = offsets_[i].Learn(first_stretch_[i], fits_[i], chosen_);
    for (std::size_t offset = 0; offset < kViews; ++offset) {
      mass[offset] += of_journey[offset];
    }
  }
  anywhere_ = PathOffsets::Mix(mass);
  ++instants_;
}

}  // namespace homing
