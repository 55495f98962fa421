#include "client/camera_observations.h"

#include <gtest/gtest.h>

#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

constexpr char kScene[] = "sim:street,length=4,fps=2";

std::optional<FlowOptions> FlowIf(bool flow) {
  return flow ? std::make_optional(FlowOptions()) : std::nullopt;
}

CameraObservations Over(Cameras cameras, bool flow, const FrameChoice& choice = {}) {
  auto instants = CameraInstants::Create(std::move(cameras), choice);
  EXPECT_THAT(instants, IsOk());
  return CameraObservations(*std::move(instants), FlowIf(flow));
}

CameraObservations Open(const std::string& left, const std::string& right, bool flow,
                        const FrameChoice& choice = {}) {
  return Over(*OpenCameras(left, right), flow, choice);
}

std::vector<std::string> All(CameraObservations& observations) {
  std::vector<std::string> all;
  while (true) {
    const auto next = observations.Next();
    EXPECT_THAT(next, IsOk());
    if (!next.ok() || !*next) return all;
    EXPECT_EQ((*next)->sequence(), static_cast<std::int64_t>(all.size()));
    all.push_back((*next)->SerializeAsString());
  }
}

// A camera that gives noise for ever and cannot go back.
class LiveCamera : public FrameSource {
 public:
  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    SourceFrame frame{FrameEncoding::kGray8, 64, 48, std::string(64 * 48, '\0'), 7};
    for (char& pixel : frame.data) {
      state_ = state_ * 1103515245 + 12345;
      pixel = static_cast<char>(state_ >> 16);
    }
    return std::make_optional(std::move(frame));
  }
  bool Seek(std::int64_t) override { return false; }
  bool live() const override { return true; }

 private:
  unsigned state_ = 1;
};

TEST(CameraObservationsTest, WantsACamera) {
  EXPECT_THAT(OpenCameras("", ""),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--left")));
}

TEST(CameraObservationsTest, SendsTheFramesOfBothCameras) {
  auto observations = Open(kScene, kScene, false);
  const auto first = observations.Next();
  ASSERT_THAT(first, IsOk());
  EXPECT_EQ((*first)->left().frame().encoding(), v1::FRAME_ENCODING_GRAY8);
  EXPECT_EQ((*first)->left().frame().width(), 320);
  EXPECT_EQ((*first)->right().frame().data().size(), 320U * 240U);
  EXPECT_NE((*first)->left().frame().data(), (*first)->right().frame().data());
}

TEST(CameraObservationsTest, FlowHasTheFramesThatMakeAStep) {
  auto frames = Open(kScene, "", false);
  auto flow = Open(kScene, "", true);
  const auto frame_count = frames.size();
  EXPECT_EQ(static_cast<std::int64_t>(All(frames).size()), frame_count);
  EXPECT_EQ(flow.size(), frame_count);
  EXPECT_EQ(static_cast<std::int64_t>(All(flow).size()), frame_count - 1);
}

// 5 mm a frame.
TEST(CameraObservationsTest, FlowOfASlowRobotNamesTheFrameAndGoesOnFromIt) {
  constexpr char kSlow[] = "sim:street,length=1,speed=0.5,fps=60";
  auto observations = Open(kSlow, "", true);
  std::vector<v1::Observation> all;
  for (auto next = observations.Next(); next.ok() && *next; next = observations.Next()) {
    all.push_back(**next);
  }
  ASSERT_GE(all.size(), 6U);
  EXPECT_LE(static_cast<std::int64_t>(all.size()), observations.size() / 2);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_EQ(all[i].sequence(), static_cast<std::int64_t>(i));
    EXPECT_GT(all[i].frame(), all[i - 1].frame());
  }
  for (const std::size_t from : {1U, 2U, 5U}) {
    // By the frame of the step before, as the server tells it; and without it.
    for (const bool is_told : {true, false}) {
      if (is_told) observations.set_last_frame(all[from - 1].frame());
      ASSERT_TRUE(observations.Seek(static_cast<std::int64_t>(from)));
      const auto next = observations.Next();
      ASSERT_THAT(next, IsOk());
      EXPECT_EQ((*next)->SerializeAsString(), all[from].SerializeAsString()) << from;
    }
  }
}

TEST(CameraObservationsTest, SendsTheFlowOfTheCameraThatIsThere) {
  auto flow = Open("", kScene, true);
  const auto first = flow.Next();
  ASSERT_THAT(first, IsOk());
  EXPECT_FALSE((*first)->has_left());
  EXPECT_EQ((*first)->right().flow_vectors().width(), 320);
  EXPECT_GT((*first)->right().flow_vectors().start_x_size(), 8);
}

TEST(CameraObservationsTest, SeekGivesTheSameObservationsAgain) {
  for (const bool send_flow : {false, true}) {
    auto observations = Open(kScene, kScene, send_flow);
    const auto all = All(observations);
    ASSERT_GE(all.size(), 4U);
    for (std::size_t from = 0; from < all.size(); ++from) {
      ASSERT_TRUE(observations.Seek(static_cast<std::int64_t>(from)));
      const auto next = observations.Next();
      ASSERT_THAT(next, IsOk());
      EXPECT_EQ((*next)->SerializeAsString(), all[from]) << from;
    }
  }
}

TEST(CameraObservationsTest, SeekBeyondTheEndGivesNothing) {
  auto observations = Open(kScene, "", false);
  ASSERT_TRUE(observations.Seek(10000));
  const auto next = observations.Next();
  ASSERT_THAT(next, IsOk());
  EXPECT_FALSE(next->has_value());
}

TEST(CameraObservationsTest, ALiveCameraContinuesWithABreak) {
  for (const bool send_flow : {false, true}) {
    Cameras cameras;
    cameras[0] = std::make_unique<LiveCamera>();
    CameraObservations observations = Over(std::move(cameras), send_flow);
    EXPECT_EQ(observations.size(), -1);
    EXPECT_FALSE(observations.Seek(0));
    observations.ContinueAt(17);
    const auto first = observations.Next();
    const auto second = observations.Next();
    EXPECT_EQ((*first)->sequence(), 17);
    // No flow spans the break.
    EXPECT_EQ((*first)->break_before(), !send_flow);
    EXPECT_EQ((*first)->capture_time().nanos(), 7);
    EXPECT_EQ((*second)->sequence(), 18);
    EXPECT_FALSE((*second)->break_before());
  }
}

TEST(CameraObservationsTest, AStopEndsALiveCamera) {
  std::stop_source stop;
  FrameChoice choice;
  choice.stop = stop.get_token();
  Cameras cameras;
  cameras[0] = std::make_unique<LiveCamera>();
  auto observations = Over(std::move(cameras), false, choice);
  EXPECT_TRUE(observations.Next()->has_value());
  stop.request_stop();
  while (observations.Next()->has_value()) {
  }
}

}  // namespace
}  // namespace homing::client
