#include "homing/profile/profile_likelihood.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace homing {
namespace {

// Stored profiles that are sampled, evenly, to estimate the distance to different places: this many
// to twice as many, or all of a smaller map.
constexpr std::int64_t kSamples = 256;
// Once the place is known, offsets that are less probable than this take turns: one at each
// observation.
constexpr double kLeastOffset = 0.05;

bool IsEnough(const std::optional<ProfileMaker>& seen) {
  return seen && seen->size() >= OdometerReading::kLeastVectors;
}

bool HasProfiles(const JourneyRef& journey, std::size_t side) {
  return !journey.map->profiles(Side{static_cast<int>(side)}).empty();
}

// Stored profiles, and their biases.
struct Sample {
  std::vector<const FlowProfile*> profiles;
  std::vector<std::int16_t> biases;
};

Sample SampleOf(std::span<const JourneyRef> journeys, Routes routes, Side side) {
  std::int64_t all = 0;
  for (const JourneyRef& journey : journeys) {
    all += std::ssize(journey.map->profiles(side));
  }
  const std::int64_t stride = std::max<std::int64_t>(1, all / kSamples);
  Sample sample;
  sample.profiles.reserve(2 * kSamples);
  sample.biases.reserve(2 * kSamples);
  std::int64_t next = 0;
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    const auto stored = journeys[i].map->profiles(side);
    if (stored.empty()) continue;
    const std::vector<std::int16_t>& bias = routes[i]->sides[static_cast<std::size_t>(side)]->bias;
    for (; next < std::ssize(stored); next += stride) {
      sample.profiles.push_back(&stored[static_cast<std::size_t>(next)]);
      sample.biases.push_back(bias[static_cast<std::size_t>(next)]);
    }
    next -= std::ssize(stored);
  }
  return sample;
}

}  // namespace

bool ProfileLikelihood::CanCompare(std::span<const JourneyRef> journeys, const SeenProfiles& seen) {
  return std::ranges::any_of(journeys, [&seen](const JourneyRef& journey) {
    return (IsEnough(seen[0]) && HasProfiles(journey, 0)) ||
           (IsEnough(seen[1]) && HasProfiles(journey, 1));
  });
}

void ProfileLikelihood::Grow(std::span<const JourneyRef> journeys) {
  routes_.resize(journeys.size());
  extended_.resize(journeys.size());
  measured_.resize(journeys.size());
  for (Belief& belief : beliefs_) belief.offsets.resize(journeys.size());
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    const JourneyMap& map = *journeys[i].map;
    for (Belief& belief : beliefs_) belief.offsets[i].Grow(map.step_count());
    const std::shared_ptr<const RouteScale> scale = MeasuredScale(map);
    if (scale == measured_[i] && extended_[i] == map.step_count()) continue;
    measured_[i] = scale;
    extended_[i] = map.step_count();
    routes_[i] = scale->step_count == map.step_count()
                     ? scale
                     : std::make_shared<const RouteScale>(ExtendedRoute(*scale, map));
  }
}

void ProfileLikelihood::Compute(std::span<const JourneyRef> journeys, const SeenProfiles& seen,
                                std::span<const StepMass> predicted, double weight) {
  weight_ = weight;
  first_steps_.clear();
  for (const StepMass& of_journey : predicted) first_steps_.push_back(of_journey.first);
  for (std::size_t side = 0; side < seen.size(); ++side) {
    compared_[side] =
        IsEnough(seen[side]) && std::ranges::any_of(journeys, [side](const JourneyRef& journey) {
          return HasProfiles(journey, side);
        });
  }
  seeing_ = compared_[0] && compared_[1] ? Seeing::kBothSides : Seeing::kOneSide;
  Choose(journeys, predicted);
  for (std::size_t side = 0; side < seen.size(); ++side) {
    if (compared_[side]) {
      Measure(journeys, Side{static_cast<int>(side)}, *seen[side], predicted);
    }
  }
  Weigh(predicted);
}

// Chooses the offsets to try. While every step is possible, all offsets are tried; later the
// probable ones and one other in turn.
void ProfileLikelihood::Choose(std::span<const JourneyRef> journeys,
                               std::span<const StepMass> predicted) {
  bool all = true;
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    all = all && std::ssize(predicted[i].mass) == journeys[i].map->step_count();
  }
  const std::ptrdiff_t likeliest = std::ranges::max_element(anywhere()) - anywhere().begin();
  const auto in_turn = static_cast<std::size_t>(instants_) % kViews;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    chosen_[offset] = all || anywhere()[offset] >= kLeastOffset || offset == in_turn ||
                      std::ptrdiff_t(offset) == likeliest ||
                      (offset == kNoOffset && seeing_ == Seeing::kOneSide);
  }
}

std::vector<ProfileLikelihood::SeenView> ProfileLikelihood::ViewsOf(
    std::size_t side, const ProfileMaker& seen) const {
  std::vector<SeenView> views;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    if (!chosen_[offset]) continue;
    const std::size_t view = ViewOf(side, offset);
    views.push_back({view, MakeView(seen, seeing_, view)});
  }
  return views;
}

void ProfileLikelihood::Measure(std::span<const JourneyRef> journeys, Side side,
                                const ProfileMaker& seen, std::span<const StepMass> predicted) {
  const auto at = static_cast<std::size_t>(side);
  const std::vector<SeenView>& views = views_[at] = ViewsOf(at, seen);
  // All views at once: each stored profile is read once.
  std::vector<ProfileView> compared;
  compared.reserve(views.size());
  const auto [sample, biases] = SampleOf(journeys, routes_, side);
  std::vector<std::uint16_t> of_sample(views.size() * sample.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    compared.push_back({views[i].profile, CoveredBy(seeing_, views[i].view),
                        std::span(of_sample).subspan(i * sample.size(), sample.size())});
  }
  ProfileDistances(compared, std::span(sample));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto distances = compared[i].distances;
    for (std::size_t j = 0; j < distances.size(); ++j) {
      distances[j] = static_cast<std::uint16_t>(std::max(0, distances[j] - biases[j]));
    }
    scales_[at][views[i].view] = ScaleOf(distances);
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
      compared.push_back({profile, CoveredBy(seeing_, view), distances});
    }
    ProfileDistances(compared, stored);
  }
}

void ProfileLikelihood::Multiply(std::size_t side, std::size_t view, std::size_t journey,
                                 std::int64_t first, std::vector<float>& factors) const {
  const std::vector<std::uint16_t>& distances = distances_[side][view][journey];
  if (distances.empty()) {
    return;
  }
  const std::span<const std::int16_t> bias = routes_[journey]->sides[side]->bias;
  ProfileRatio::OfWeight(weight_).Multiply(
      distances, bias.subspan(static_cast<std::size_t>(first), distances.size()),
      scales_[side][view], std::span(factors).first(distances.size()));
}

float ProfileLikelihood::WeightOf(std::size_t offset, std::size_t journey,
                                  std::size_t stretch) const {
  const OffsetValues& believed = belief().offsets[journey].of(stretch);
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
  }
}

// Each step's ratio is the mean over the offsets, as they are believed there.
void ProfileLikelihood::Weigh(std::span<const StepMass> predicted) {
  likelihoods_.resize(predicted.size());
  fits_.resize(predicted.size());
  first_stretch_.resize(predicted.size());
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const std::int64_t first = predicted[i].first;
    const std::int64_t end = first + std::ssize(predicted[i].mass);
    likelihoods_[i].assign(predicted[i].mass.size(), 0);
    first_stretch_[i] = static_cast<std::size_t>(first / PathOffsets::kStretch);
    fits_[i].assign(PathOffsets::StretchesOf(end) - first_stretch_[i], OffsetValues{});
    for (std::size_t offset = 0; offset < kViews; ++offset) {
      if (!chosen_[offset]) continue;
      factors_.assign(predicted[i].mass.size(), 1);
      for (std::size_t side = 0; side < compared_.size(); ++side) {
        if (compared_[side]) Multiply(side, ViewOf(side, offset), i, first, factors_);
      }
      AddOffset(offset, i, predicted[i]);
    }
  }
}

// In each stretch, an offset gains if the believed steps fit under it.
void ProfileLikelihood::Learn() {
  OffsetValues mass{};
  for (std::size_t i = 0; i < belief().offsets.size(); ++i) {
    const OffsetValues of_journey = belief().offsets[i].Learn(first_stretch_[i], fits_[i], chosen_);
    for (std::size_t offset = 0; offset < kViews; ++offset) {
      mass[offset] += of_journey[offset];
    }
  }
  belief().anywhere = PathOffsets::Mix(mass);
  ++instants_;
}

void ProfileLikelihood::Release() {
  for (auto& views : distances_) views.fill({});
  likelihoods_.clear();
  fits_.clear();
  factors_ = {};
}

void ProfileLikelihood::StartAtOffset(double offset) {
  OffsetValues start{};
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < kViews; ++i) {
    if (std::abs(kPathOffsets[i] - offset) < std::abs(kPathOffsets[nearest] - offset)) nearest = i;
  }
  start[nearest] = 1;
  beliefs_[0].anywhere = PathOffsets::Mix(start);
}

double ProfileLikelihood::MeanOffset() const {
  double mean = 0;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    mean += beliefs_[0].anywhere[offset] * kPathOffsets[offset];
  }
  return mean;
}

}  // namespace homing
