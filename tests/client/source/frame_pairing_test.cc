#include "client/source/frame_pairing.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

using Instants = std::vector<std::array<std::int64_t, 2>>;

FramePairing Pair(FrameKeys::Kind kind, const std::vector<std::int64_t>& left,
                  const std::vector<std::int64_t>& right) {
  return PairFrames({kind, left}, static_cast<std::int64_t>(left.size()), {kind, right},
                    static_cast<std::int64_t>(right.size()));
}

TEST(FramePairingTest, ByNumberLeavesGapsOpen) {
  const auto pairing = Pair(FrameKeys::Kind::kNumber, {0, 1, 2, 3}, {0, 3, 4});
  EXPECT_EQ(pairing.by, "number");
  EXPECT_EQ(pairing.instants, (Instants{{0, 0}, {1, -1}, {2, -1}, {3, 1}, {-1, 2}}));
  EXPECT_EQ(pairing.alone, (std::array<std::int64_t, 2>{2, 1}));
}

TEST(FramePairingTest, ByTimeTakesTheNearest) {
  const auto pairing = Pair(FrameKeys::Kind::kTime, {0, 100, 200, 300}, {30, 190, 310});
  EXPECT_EQ(pairing.by, "time");
  EXPECT_EQ(pairing.instants, (Instants{{0, 0}, {1, -1}, {2, 1}, {3, 2}}));
}

TEST(FramePairingTest, ByTimeOfASlowAndAFastCamera) {
  const auto pairing = Pair(FrameKeys::Kind::kTime, {0, 100, 200, 300, 400}, {0, 200, 400});
  EXPECT_EQ(pairing.alone, (std::array<std::int64_t, 2>{2, 0}));
  EXPECT_EQ(pairing.instants, (Instants{{0, 0}, {1, -1}, {2, 1}, {3, -1}, {4, 2}}));
}

TEST(FramePairingTest, NumbersThatHaveNothingInCommonGoByOrder) {
  const auto pairing = Pair(FrameKeys::Kind::kNumber, {0, 2, 4}, {1, 3});
  EXPECT_EQ(pairing.by, "order");
  EXPECT_EQ(pairing.instants, (Instants{{0, 0}, {1, 1}, {2, -1}}));
  EXPECT_EQ(pairing.alone, (std::array<std::int64_t, 2>{1, 0}));
}

TEST(FindHolesTest, ALongIntervalIsAHole) {
  constexpr std::int64_t kMs = 1'000'000;
  const auto holes = [](const std::vector<std::int64_t>& times) {
    return FindHoles({FrameKeys::Kind::kTime, times});
  };
  using Indices = std::vector<std::int64_t>;
  EXPECT_EQ(holes({0, 100 * kMs, 200 * kMs, 801 * kMs, 901 * kMs, 1502 * kMs}), (Indices{3, 5}));
  // A pause of half a second, five intervals of a slow camera, and no times.
  EXPECT_EQ(holes({0, 100 * kMs, 200 * kMs, 700 * kMs}), Indices());
  EXPECT_EQ(holes({0, 1000 * kMs, 2000 * kMs, 7000 * kMs}), Indices());
  EXPECT_EQ(FindHoles({FrameKeys::Kind::kNumber, {1, 2, 3, 1000 * kMs}}), Indices());
  EXPECT_EQ(holes({}), Indices());
}

TEST(FramePairingTest, WithoutKeysGoesByOrder) {
  const auto pairing = PairFrames({}, 2, {FrameKeys::Kind::kNumber, {5, 6, 7}}, 3);
  EXPECT_EQ(pairing.instants, (Instants{{0, 0}, {1, 1}, {-1, 2}}));
}

}  // namespace
}  // namespace homing::client
