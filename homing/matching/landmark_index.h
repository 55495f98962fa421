// An index that finds landmarks by P_T without comparing with all (paper III, eqs 13 to 15).
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

// Gives the same answers as a scan of all fingerprints, to the bit: a search skips only what a
// bound of P_T excludes (1 - F falls with delta, the ratio of the counts with their difference).
// Each journey uses its own deviation model; journeys of one model share a tree a side. An append
// costs the same at any size, and the next search finds it. Memory: 20 bytes a fingerprint in
// buckets that are 70 % full on average, and 12 a landmark. Not thread-safe; any number of threads
// may search while none changes it.
class LandmarkIndex {
 public:
  // True if the search covers the journey with this number.
  using Covers = std::function<bool(int journey)>;

  // The number of a new journey; numbers of removed and swept journeys are reused. REQUIRES: no
  // journey of that name is in the index.
  int AddJourney(std::string name, const DeviationModel& model);
  // REQUIRES: the journey is in the index; the rules of JourneyMap::Append hold for the step.
  void Append(int journey, const JourneyStep& step);
  // All steps of a map from `first` on.
  void Append(int journey, const JourneyMap& map, std::int64_t first = 0);
  // Appends between these two calls are inserted by EndLoading, all at once: this is faster and
  // takes fewer bytes. REQUIRES: the index is empty; no search in between.
  void BeginLoading() { loading_ = true; }
  void EndLoading();
  // Searches no longer find the journey. Sweep frees its memory and its number.
  void Remove(int journey);
  // Frees the removed entries of the next `buckets` buckets. False: none is left.
  bool Sweep(std::uint32_t buckets);

  // As Matcher::Find over all covered journeys. Match::journey is the number here.
  std::vector<Match> FindLandmarks(const SeenSides& seen, const MatchOptions& options,
                                   const Covers& covers, SearchCost* cost = nullptr) const;
  // The same for single fingerprints, instead of the best one of each landmark.
  std::vector<Match> FindFingerprints(const SeenSides& seen, const MatchOptions& options,
                                      const Covers& covers, SearchCost* cost = nullptr) const;

  const std::string& name(int journey) const { return Of(journey).name; }
  // Numbers in use, and those of removed journeys.
  int journey_count() const { return static_cast<int>(journeys_.size()); }
  bool removed(int journey) const { return Of(journey).removed; }
  // Fingerprints of journeys that are not removed.
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
    // Entries being loaded, by side.
    std::array<std::vector<TreeEntry>, 2> loading;
  };
  struct Journey {
    std::string name;
    Group* group = nullptr;
    // Index: the landmark's number in the journey. Value: its number here.
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
  // Groups by mu and sigma.
  std::map<std::pair<double, double>, std::unique_ptr<Group>> groups_;
  ChunkedArray<LandmarkOf, 1024> landmarks_;
  std::int64_t fingerprint_count_ = 0;
  bool loading_ = false;
  // Journeys removed since the current sweep began, and before it.
  std::vector<int> removed_;
  std::vector<int> sweeping_;
  // The place where Sweep continues: a tree, counted over groups and sides, and a bucket.
  std::size_t sweep_tree_ = 0;
  std::uint32_t sweep_bucket_ = 0;
  // Free numbers: no tree holds an entry of them.
  std::vector<int> free_journeys_;
  std::vector<std::uint32_t> free_landmarks_;
};

}  // namespace homing

#endif  // HOMING_MATCHING_LANDMARK_INDEX_H_
