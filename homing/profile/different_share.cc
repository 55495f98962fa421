#include "homing/profile/different_share.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "homing/flow/median.h"
#include "homing/profile/profile_distance.h"

namespace homing {
namespace {

// Stretches of the map that are compared with all others.
constexpr std::int64_t kStretches = 32;
// Pairs of places along a stretch.
constexpr std::int64_t kPairs = 4;
// Places this many correlation lengths apart are different places.
constexpr double kDifferentPlaces = 4;

// Distances to all steps of the map.
using Distances = std::vector<std::uint16_t>;

// All in steps.
struct Lengths {
  explicit Lengths(double correlation_steps)
      : stretch(std::lround(kStretchLengths * correlation_steps)),
        spacing(std::max(1L, std::lround(kStretchLengths / kPairs * correlation_steps))),
        different(static_cast<std::int64_t>(std::ceil(kDifferentPlaces * correlation_steps))) {}

  std::int64_t all() const { return stretch + (kPairs - 1) * spacing; }

  std::int64_t stretch;
  // Distance from one pair of places along the stretch to the next.
  std::int64_t spacing;
  // Places further apart are different.
  std::int64_t different;
};

// Distances of the place at the front of a stretch, and of the one at its back.
struct PairRows {
  Distances front;
  Distances back;
};

std::vector<PairRows> RowsOf(std::span<const FlowProfile> stored, std::int64_t end,
                             const Lengths& lengths) {
  static const CellMask all = CoveredCells(1);
  std::vector<PairRows> pairs(kPairs);
  std::vector<ProfileView> views;
  for (std::int64_t i = 0; i < kPairs; ++i) {
    PairRows& pair = pairs[static_cast<std::size_t>(i)];
    pair.front.resize(stored.size());
    pair.back.resize(stored.size());
    const auto front = static_cast<std::size_t>(end - i * lengths.spacing);
    const auto back = front - static_cast<std::size_t>(lengths.stretch);
    views.push_back({stored[front], all, pair.front});
    views.push_back({stored[back], all, pair.back});
  }
  ProfileDistances(views, stored);
  return pairs;
}

// The other stretches whose front place is `first` to `last`, and which run as this one does (1)
// or against it (-1).
struct Others {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t way = 1;
};

// Adds to `shares`, for each of the others, the change that it shares with the stretch of `pairs`,
// times `per_unit`.
void AddShares(std::span<const PairRows> pairs, const Others& others, const Lengths& lengths,
               float per_unit, std::vector<float>& shares) {
  shares.resize(
      static_cast<std::size_t>(std::max<std::int64_t>(0, others.last - others.first + 1)));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::int64_t front =
        others.first - others.way * static_cast<std::int64_t>(i) * lengths.spacing;
    const std::int64_t back = front - others.way * lengths.stretch;
    const std::uint16_t* const a = pairs[i].front.data();
    const std::uint16_t* const b = pairs[i].back.data();
    for (std::size_t j = 0; j < shares.size(); ++j) {
      const auto at_front = static_cast<std::size_t>(front) + j;
      const auto at_back = static_cast<std::size_t>(back) + j;
      const int crossed = int{a[at_back]} + int{b[at_front]};
      const int own = int{a[at_front]} + int{b[at_back]};
      shares[j] += per_unit * static_cast<float>(crossed - own);
    }
  }
}

// Stretches whose places are different from those of the one that ends at `end`, place by place.
std::vector<Others> OthersOf(std::int64_t end, std::int64_t steps, const Lengths& lengths) {
  const std::int64_t all = lengths.all(), apart = lengths.different;
  return {{all, end - apart, 1},
          {end + apart, steps - 1, 1},
          {0, end - 2 * all - apart, -1},
          {end + apart, steps - 1 - all, -1}};
}

// The most similar other stretch, indexed by the compared sides as RouteScale::different_share;
// negative: there is no other stretch.
std::array<float, 4> MostShared(const JourneyMap& map, const RouteScale& route, std::int64_t end,
                                const Lengths& lengths) {
  std::array<std::vector<PairRows>, 2> rows;
  for (std::size_t side = 0; side < rows.size(); ++side) {
    if (route.sides[side]) {
      rows[side] = RowsOf(map.profiles(Side{static_cast<int>(side)}), end, lengths);
    }
  }
  std::array<float, 4> most;
  most.fill(-1);
  for (const Others& others : OthersOf(end, map.step_count(), lengths)) {
    for (std::size_t sides = 1; sides < most.size(); ++sides) {
      std::vector<float> shares;
      const float parts = sides == 3 ? 2 : 1;
      for (std::size_t side = 0; side < rows.size(); ++side) {
        if ((sides >> side & 1) == 0 || rows[side].empty()) continue;
        AddShares(rows[side], others, lengths,
                  1 / (2 * parts * kPairs * route.sides[side]->stretch_distance), shares);
      }
      for (const float share : shares) most[sides] = std::max(most[sides], share);
    }
  }
  return most;
}

}  // namespace

void MeasureDifferentShare(const JourneyMap& map, RouteScale& route) {
  const Lengths lengths(route.correlation_steps);
  const std::int64_t room = map.step_count() - lengths.all();
  std::array<std::vector<float>, 4> all;
  for (std::int64_t i = 0; i < std::min(room, kStretches); ++i) {
    const std::int64_t end = lengths.all() + i * room / std::min(room, kStretches);
    const std::array<float, 4> most = MostShared(map, route, end, lengths);
    for (std::size_t sides = 0; sides < most.size(); ++sides) {
      if (most[sides] >= 0) all[sides].push_back(most[sides]);
    }
  }
  for (std::size_t sides = 0; sides < all.size(); ++sides) {
    if (!all[sides].empty()) {
      route.different_share[sides] = Median(std::span<const float>(all[sides]));
    }
  }
}

}  // namespace homing
