// The paper's experiments (IV, Figs 3 to 7) through the whole method: simulated frames, flow,
// landmarks, fingerprints, P_T. The reference at time t is what the reference drive (11 m, 4 km/h)
// saw at the same t; docs/algorithm.md says why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "homing/flow/camera.h"
#include "homing/flow/flow_tracker.h"
#include "homing/landmark/landmark_finder.h"
#include "homing/similarity/similarity.h"
#include "tests/client/simulator/paper_scenes.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::Each;
using ::testing::Ge;
using ::testing::Lt;

// Each experiment is made with this many pairs of drives, which differ in noise and exposure: two
// fingerprints of one landmark scatter by about 3 px. Every pair must be on its side of the
// threshold; what compares experiments compares their means.
constexpr int kTrials = 6;

// Landmarks of the flow between the contiguous frames that end at `t_s`.
std::vector<SeenLandmark> SeenAt(const Simulator& simulator, double t_s, Side camera) {
  FlowTracker tracker{FlowOptions()};
  const auto frame = static_cast<std::int64_t>(t_s * kPaperFps + 0.5);
  EXPECT_THAT(tracker.Track(simulator.RenderCamera(frame - 1, camera)), IsOk());
  tracker.Advance();
  const auto field = tracker.Track(simulator.RenderCamera(frame, camera));
  EXPECT_THAT(field, IsOk());
  return FindLandmarks(Rectify(field.value().value(), Camera()), LandmarkOptions());
}

struct Drive {
  Scene scene;
  double speed_kmh;
};

// From low x to high x.
std::vector<SeenLandmark> Drove(const Drive& drive, double t_s, int seed) {
  const auto simulator = DrivePast(drive.scene, drive.speed_kmh, static_cast<std::uint64_t>(seed));
  EXPECT_THAT(simulator, IsOk());
  EXPECT_TRUE(SeenAt(**simulator, t_s, Side::kRight).empty());
  return SeenAt(**simulator, t_s, Side::kLeft);
}

struct Scores {
  std::vector<double> p_t;
  double delta = 0;
  double reference_count = 0;
  double count = 0;

  double Mean() const {
    double sum = 0;
    for (const double value : p_t) {
      sum += value;
    }
    return sum / static_cast<double>(p_t.size());
  }
};

// Similarity of each of `landmarks` landmarks between two drives, over all trials.
std::vector<Scores> Compare(const Drive& reference, const Drive& current, double t_s,
                            std::size_t landmarks) {
  std::vector<Scores> scores(landmarks);
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto i = Drove(reference, t_s, 1 + 2 * trial);
    const auto j = Drove(current, t_s, 2 + 2 * trial);
    EXPECT_EQ(i.size(), landmarks);
    EXPECT_EQ(j.size(), landmarks);
    for (std::size_t k = 0; k < std::min({landmarks, i.size(), j.size()}); ++k) {
      const Similarity similarity =
          Compare(MeanAndCount{i[k].x, i[k].y, static_cast<double>(i[k].count)},
                  MeanAndCount{j[k].x, j[k].y, static_cast<double>(j[k].count)}, DeviationModel());
      scores[k].p_t.push_back(similarity.p_t);
      scores[k].delta += similarity.delta / kTrials;
      scores[k].reference_count += i[k].count / double{kTrials};
      scores[k].count += j[k].count / double{kTrials};
    }
  }
  return scores;
}

void Print(const std::string& figure, const Scores& scores) {
  ASSERT_FALSE(scores.p_t.empty()) << figure;
  const auto [low, high] = std::minmax_element(scores.p_t.begin(), scores.p_t.end());
  std::printf("%-28s P_T %5.2f %% (%5.2f .. %5.2f), delta %5.2f px, vectors %.0f and %.0f\n",
              figure.c_str(), 100 * scores.Mean(), 100 * *low, 100 * *high, scores.delta,
              scores.reference_count, scores.count);
}

const std::vector<double>& Times() {
  static const std::vector<double> times = {0.3, 0.6, 0.9};
  return times;
}

Drive Reference() { return {ReferenceScene(11), 4}; }

std::vector<Scores> OverTime(const std::string& figure, const Drive& current) {
  std::vector<Scores> result;
  for (const double t_s : Times()) {
    result.push_back(Compare(Reference(), current, t_s, 1).at(0));
    Print(figure + ", t = " + std::to_string(t_s).substr(0, 3) + " s", result.back());
  }
  return result;
}

TEST(PaperTest, Figure5TheReferenceIsRecognisedLessWithTimeAndDistanceTellsMoreThanSpeed) {
  const auto speed = OverTime("5a-c 11 m, 5 km/h", {ReferenceScene(11), 5});
  const auto distance = OverTime("5d-f 8 m, 4 km/h", {ReferenceScene(8), 4});
  for (const Scores& at : speed) {
    EXPECT_THAT(at.p_t, Each(Ge(0.20)));
  }
  EXPECT_GT(speed[0].Mean(), speed[1].Mean());
  EXPECT_GT(speed[1].Mean(), speed[2].Mean());
  EXPECT_THAT(distance[0].p_t, Each(Ge(0.20)));
  for (std::size_t t = 0; t < Times().size(); ++t) {
    EXPECT_LT(distance[t].Mean(), speed[t].Mean()) << Times()[t];
  }
}

TEST(PaperTest, Figure6CATowerIsNotTheReference) {
  const Scores scores = Compare(Reference(), {TowerScene(11), 4}, 0.3, 1).at(0);
  Print("6c tower", scores);
  EXPECT_THAT(scores.p_t, Each(Lt(0.20)));
}

TEST(PaperTest, Figure6DAParallelogramAlikeInPlaceAndNumberIsTakenForTheReference) {
  const Scores scores = Compare(Reference(), {ParallelogramScene(11), 4}, 0.3, 1).at(0);
  Print("6d parallelogram", scores);
  EXPECT_THAT(scores.p_t, Each(Ge(0.20)));
}

TEST(PaperTest, Figure7CSphereAndTowerAreRecognisedFromTwoMetresFurther) {
  const auto scores = Compare({SphereAndTowerScene(5), 4}, {SphereAndTowerScene(7), 5}, 0.3, 2);
  Print("7c sphere", scores[0]);
  Print("7c tower", scores[1]);
  EXPECT_THAT(scores[0].p_t, Each(Ge(0.20)));
  EXPECT_THAT(scores[1].p_t, Each(Ge(0.20)));
}

TEST(PaperTest, Figure7DHillAndOtherTowerAreNotSphereAndTower) {
  const auto scores = Compare({SphereAndTowerScene(5), 4}, {HillAndTowerScene(7), 5}, 0.3, 2);
  Print("7d hill and sphere", scores[0]);
  Print("7d towers", scores[1]);
  EXPECT_THAT(scores[0].p_t, Each(Lt(0.20)));
  EXPECT_THAT(scores[1].p_t, Each(Lt(0.20)));
}

}  // namespace
}  // namespace homing::client
