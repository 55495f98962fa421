#include "homing/matching/landmark_index.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

namespace homing {
namespace {

MeanAndCount Of(float x, float y, std::int32_t count) {
  return {double{x}, double{y}, static_cast<double>(count)};
}

}  // namespace

// Keeps the best matches so far, in order.
class LandmarkIndex::Finder : public TreeVisitor {
 public:
  Finder(const LandmarkIndex& index, const MatchOptions& options, const Covers& covers,
         bool distinct)
      : index_(index), options_(options), covers_(covers), distinct_(distinct) {
    // A P_T of 0 is no match.
    least_ = std::max(options.threshold, std::numeric_limits<double>::denorm_min());
  }

  void Look(const SeenLandmark& seen, const Group& group, Side side) {
    seen_ = &seen;
    group_ = &group;
    side_ = side;
  }

  void Consider(const TreeEntry& entry) override {
    const Found found{entry.landmark, entry.step, side_,
                      Compare(homing::Of(seen_->x, seen_->y, seen_->count),
                              homing::Of(entry.x, entry.y, entry.count), group_->model)};
    if (found.similarity.p_t >= least_ && IsCovered(entry.landmark) && DropWorse(found)) {
      Keep(found);
    }
  }

  std::vector<Match> Take() const {
    std::vector<Match> matches;
    for (const Found& found : found_) {
      const LandmarkOf of = index_.landmarks_[found.landmark];
      matches.push_back({of.journey, of.landmark, found.step, found.side, found.similarity});
    }
    return matches;
  }

 private:
  // A match with the landmark's number in the index; the end of the search translates it.
  struct Found {
    std::uint32_t landmark = 0;
    std::int64_t step = 0;
    Side side = Side::kLeft;
    Similarity similarity;
  };

  bool IsCovered(std::uint32_t landmark) const {
    if (!index_.IsSweeping() && !covers_) {
      return true;
    }
    const int journey = index_.landmarks_[landmark].journey;
    return !index_.Of(journey).removed && (!covers_ || covers_(journey));
  }

  bool IsBetter(const Found& a, const Found& b) const {
    if (a.similarity.p_t != b.similarity.p_t) {
      return a.similarity.p_t > b.similarity.p_t;
    }
    const LandmarkOf of_a = index_.landmarks_[a.landmark];
    const LandmarkOf of_b = index_.landmarks_[b.landmark];
    if (of_a.journey != of_b.journey) {
      return index_.name(of_a.journey) < index_.name(of_b.journey);
    }
    return std::tie(a.step, a.side, of_a.landmark) < std::tie(b.step, b.side, of_b.landmark);
  }

  // False: the landmark was found already, with a step that is not worse.
  bool DropWorse(const Found& match) {
    if (!distinct_) {
      return true;
    }
    const auto known = std::find_if(found_.begin(), found_.end(), [&](const Found& found) {
      return found.landmark == match.landmark;
    });
    if (known == found_.end()) {
      return true;
    }
    if (!IsBetter(match, *known)) {
      return false;
    }
    found_.erase(known);
    return true;
  }

  void Keep(const Found& match) {
    found_.insert(
        std::upper_bound(found_.begin(), found_.end(), match,
                         [this](const Found& a, const Found& b) { return IsBetter(a, b); }),
        match);
    const auto most = static_cast<std::size_t>(options_.max_matches);
    if (found_.size() > most) {
      found_.pop_back();
    }
    if (found_.size() == most) {
      least_ = std::max(least_, found_.back().similarity.p_t);
    }
  }

  const LandmarkIndex& index_;
  const MatchOptions& options_;
  const Covers& covers_;
  const bool distinct_;
  const SeenLandmark* seen_ = nullptr;
  const Group* group_ = nullptr;
  Side side_ = Side::kLeft;
  // Best first.
  std::vector<Found> found_;
};

int LandmarkIndex::AddJourney(std::string name, const DeviationModel& model) {
  std::unique_ptr<Group>& group = groups_[{model.mu, model.sigma}];
  if (!group) {
    group = std::make_unique<Group>(model);
  }
  Journey added{std::move(name), group.get(), {}, 0, false};
  if (free_journeys_.empty()) {
    journeys_.push_back(std::move(added));
    return journey_count() - 1;
  }
  const int journey = free_journeys_.back();
  free_journeys_.pop_back();
  journeys_[static_cast<std::size_t>(journey)] = std::move(added);
  return journey;
}

std::uint32_t LandmarkIndex::NewLandmark(const LandmarkOf& landmark) {
  if (free_landmarks_.empty()) {
    return landmarks_.Add(landmark);
  }
  const std::uint32_t index = free_landmarks_.back();
  free_landmarks_.pop_back();
  landmarks_[index] = landmark;
  return index;
}

void LandmarkIndex::Insert(int journey, std::int64_t step, Side side, const Fingerprint& f) {
  Journey& into = journeys_[static_cast<std::size_t>(journey)];
  while (into.landmarks.size() <= static_cast<std::size_t>(f.landmark)) {
    const auto next = static_cast<std::int32_t>(into.landmarks.size());
    into.landmarks.push_back(NewLandmark({journey, next}));
  }
  const auto index = static_cast<std::size_t>(side);
  const TreeEntry entry{f.x, f.y, f.count, into.landmarks[static_cast<std::size_t>(f.landmark)],
                        static_cast<std::uint32_t>(step)};
  if (loading_) {
    into.group->loading[index].push_back(entry);
  } else {
    into.group->trees[index].Insert(entry);
  }
  ++into.fingerprint_count;
  ++fingerprint_count_;
}

void LandmarkIndex::Append(int journey, const JourneyStep& step) {
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    Insert(journey, step.step, recorded.side, recorded.fingerprint);
  }
}

void LandmarkIndex::Append(int journey, const JourneyMap& map, std::int64_t first) {
  for (std::int64_t step = first; step < map.step_count(); ++step) {
    for (const Fingerprint& fingerprint : map.fingerprints(step)) {
      Insert(journey, step, map.side_of(fingerprint), fingerprint);
    }
  }
}

void LandmarkIndex::EndLoading() {
  loading_ = false;
  for (const auto& [model, group] : groups_) {
    for (std::size_t side = 0; side < 2; ++side) {
      group->trees[side].Build(group->loading[side]);
      group->loading[side] = {};
    }
  }
}

void LandmarkIndex::Remove(int journey) {
  Journey& removed = journeys_[static_cast<std::size_t>(journey)];
  removed.removed = true;
  fingerprint_count_ -= removed.fingerprint_count;
  removed_.push_back(journey);
}

bool LandmarkIndex::Sweep(std::uint32_t buckets) {
  if (!IsSweeping()) {
    return false;
  }
  if (sweeping_.empty()) {
    // Starts at the first bucket. From now on entries of these journeys only move to later buckets.
    sweeping_.swap(removed_);
    sweep_tree_ = 0;
    sweep_bucket_ = 0;
  }
  auto group = groups_.begin();
  std::advance(group, std::min(sweep_tree_ / 2, groups_.size()));
  if (group == groups_.end()) {
    EndSweep();
    return IsSweeping();
  }
  FingerprintTree& tree = group->second->trees[sweep_tree_ % 2];
  tree.RemoveIf(sweep_bucket_, buckets, [this](const TreeEntry& entry) {
    return Of(landmarks_[entry.landmark].journey).removed;
  });
  sweep_bucket_ += buckets;
  if (sweep_bucket_ >= tree.bucket_count()) {
    ++sweep_tree_;
    sweep_bucket_ = 0;
  }
  return true;
}

void LandmarkIndex::EndSweep() {
  for (const int journey : sweeping_) {
    Journey& swept = journeys_[static_cast<std::size_t>(journey)];
    free_landmarks_.insert(free_landmarks_.end(), swept.landmarks.begin(), swept.landmarks.end());
    swept.landmarks = {};
    free_journeys_.push_back(journey);
  }
  sweeping_.clear();
}

void LandmarkIndex::Search(const SeenSides& seen, Finder* finder, SearchCost* cost) const {
  SearchCost unasked;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    for (const SeenLandmark& landmark : seen[static_cast<std::size_t>(side)]) {
      if (landmark.count <= 0) {
        continue;
      }
      for (const auto& [model, group] : groups_) {
        finder->Look(landmark, *group, side);
        group->trees[static_cast<std::size_t>(side)].Search(
            {landmark.x, landmark.y, landmark.count}, group->bound, finder,
            cost != nullptr ? cost : &unasked);
      }
    }
  }
}

std::vector<Match> LandmarkIndex::FindLandmarks(const SeenSides& seen, const MatchOptions& options,
                                                const Covers& covers, SearchCost* cost) const {
  Finder finder(*this, options, covers, /*distinct=*/true);
  Search(seen, &finder, cost);
  return finder.Take();
}

std::vector<Match> LandmarkIndex::FindFingerprints(const SeenSides& seen,
                                                   const MatchOptions& options,
                                                   const Covers& covers, SearchCost* cost) const {
  Finder finder(*this, options, covers, /*distinct=*/false);
  Search(seen, &finder, cost);
  return finder.Take();
}

std::size_t LandmarkIndex::MemoryBytes() const {
  std::size_t bytes = landmarks_.MemoryBytes() + journeys_.size() * sizeof(Journey);
  for (const Journey& journey : journeys_) {
    bytes += journey.name.capacity() + journey.landmarks.capacity() * sizeof(std::uint32_t);
  }
  for (const auto& [model, group] : groups_) {
    bytes += sizeof(Group) + group->trees[0].MemoryBytes() + group->trees[1].MemoryBytes();
  }
  return bytes;
}

}  // namespace homing
