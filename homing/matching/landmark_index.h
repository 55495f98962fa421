// The landmarks of all journeys, found by P_T without looking at all of them (paper III, eqs 13 to
// 15).
#ifndef HOMING_MATCHING_LANDMARK_INDEX_H_
#define HOMING_MATCHING_LANDMARK_INDEX_H_

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "homing/journey/journey_map.h"
#include "homing/matching/chunked_array.h"
#include "homing/matching/fingerprint_tree.h"
#include "homing/matching/matcher.h"

namespace homing {

// Answers as a scan of all fingerprints would, to the bit: a search leaves out only what a bound of
// P_T rules out (1 - F falls with delta, the ratio of numbers with their difference). Each journey
// is scored with its own deviation model: those of one model share a tree a side. Appending costs
// the same at any size, and is found by the next search. 20 bytes a fingerprint in buckets filled
// to 70 % on average, and 12 a landmark. Not thread-safe; any number may search while no one
// changes it.
class LandmarkIndex {
 public:
  // Whether a search covers a journey, by its number.
  using Covers = std::function<bool(int journey)>;

  // The number of a new journey, which may have been that of one removed and swept. REQUIRES: no
  // journey of that name is in the index.
  int AddJourney(std::string name, const DeviationModel& model);
  // REQUIRES: the journey is in the index; the rules of JourneyMap::Append hold for the step.
  void Append(int journey, const JourneyStep& step);
  // All steps of a map from `first` on.
  void Append(int journey, const JourneyMap& map, std::int64_t first = 0);
  // What is appended between these two is put in place at the second, all at once: faster, and in
  // fewer bytes. REQUIRES: nothing was appended before; no search between them.
  void BeginLoading() { loading_ = true; }
  void EndLoading();
  // No search finds it any more; Sweep frees its memory and its number.
  void Remove(int journey);
  // Frees what was removed from the next `buckets` buckets. False: nothing is left to free.
  bool Sweep(std::uint32_t buckets);

  // As Matcher::Find over all journeys that are covered. Match::journey is the number here.
  std::vector<Match> FindLandmarks(const SeenSides& seen, const MatchOptions& options,
                                   const Covers& covers, SearchCost* cost = nullptr) const;
  // The same, with every fingerprint for itself instead of the best one of each landmark.
  std::vector<Match> FindFingerprints(const SeenSides& seen, const MatchOptions& options,
                                      const Covers& covers, SearchCost* cost = nullptr) const;

  const std::string& name(int journey) const { return Of(journey).name; }
  // Numbers in use, and those of removed journeys.
  int journey_count() const { return static_cast<int>(journeys_.size()); }
  bool removed(int journey) const { return Of(journey).removed; }
  // Of journeys that are not removed.
  std::int64_t fingerprint_count() const { return fingerprint_count_; }
  std::size_t MemoryBytes() const;

 private:
  // Journeys of one deviation model.
  struct Group {
    explicit Group(const DeviationModel& m) : model(m), bound(m) {}
    DeviationModel model;
    SurvivalBound bound;
    // Indexed by Side of the route.
    std::array<FingerprintTree, 2> trees;
    // What is being loaded, by side.
    std::array<std::vector<TreeEntry>, 2> loading;
  };
  struct Journey {
    std::string name;
    Group* group = nullptr;
    // By the landmark's number along the journey: its number here.
    std::vector<std::uint32_t> landmarks;
    std::int64_t fingerprint_count = 0;
    bool removed = false;
  };
  struct LandmarkOf {
    std::int32_t journey = 0;
    std::int32_t landmark = 0;
  };
  class Finder;

  const Journey& Of(int journey) const { return journeys_[static_cast<std::size_t>(journey)]; }
  void Insert(int journey, std::int64_t step, Side side, const Fingerprint& fingerprint);
  std::uint32_t NewLandmark(const LandmarkOf& landmark);
  void EndSweep();
  bool IsSweeping() const { return !removed_.empty() || !sweeping_.empty(); }
  void Search(const SeenSides& seen, Finder* finder, SearchCost* cost) const;

  // Its elements never move.
  std::deque<Journey> journeys_;
  // By mu and sigma.
  std::map<std::pair<double, double>, std::unique_ptr<Group>> groups_;
  ChunkedArray<LandmarkOf, 1024> landmarks_;
  std::int64_t fingerprint_count_ = 0;
  bool loading_ = false;
  // Removed since the sweep under way began; removed before it, by number.
  std::vector<int> removed_;
  std::vector<int> sweeping_;
  // Where Sweep continues: a tree, counted over groups and sides, and a bucket.
  std::size_t sweep_tree_ = 0;
  std::uint32_t sweep_bucket_ = 0;
  // Swept: no tree holds an entry of them.
  std::vector<int> free_journeys_;
  std::vector<std::uint32_t> free_landmarks_;
};

}  // namespace homing

#endif  // HOMING_MATCHING_LANDMARK_INDEX_H_
