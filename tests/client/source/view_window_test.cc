#include "client/source/view_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client/png_file.h"
#include "homing/flow/flow_tracker.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
// Below this row is the robot's own bonnet.
constexpr int kBonnet = 160;

// A street that passes by over a bonnet that does not, both with texture.
class RobotCamera : public FrameSource {
 public:
  RobotCamera() : street_(*OpenFrameSource("sim:street,length=4,fps=4", Side::kLeft)) {}
  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    auto frame = street_->Next();
    if (!frame.ok() || !*frame) return frame;
    for (int y = kBonnet; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        (*frame)->data[static_cast<std::size_t>(y * kWidth + x)] =
            static_cast<char>((x / 9 + y / 7) % 2 == 0 ? 40 : 220);
      }
    }
    return frame;
  }
  bool Seek(std::int64_t index) override { return street_->Seek(index); }
  std::optional<Camera> camera() const override {
    Camera camera;
    camera.width = kWidth;
    camera.height = kHeight;
    camera.intrinsics = Intrinsics{277, 278, 160, 120};
    return camera;
  }

 private:
  std::unique_ptr<FrameSource> street_;
};

std::string WriteMask(const TemporaryFolder& folder, int width, int white_rows) {
  SourceFrame mask{FrameEncoding::kGray8, width, kHeight, {}, 0};
  for (int y = 0; y < kHeight; ++y) {
    mask.data += std::string(static_cast<std::size_t>(width), y < white_rows ? '\xff' : '\0');
  }
  EXPECT_THAT(WritePng(folder.File("mask.png"), mask), IsOk());
  return folder.File("mask.png");
}

// Of the second pair of frames.
struct Vectors {
  int moving = 0;
  int still = 0;
  int on_the_bonnet = 0;
};
Vectors Track(FrameSource& source) {
  FlowTracker tracker{FlowOptions()};
  std::optional<FlowField> field;
  for (int i = 0; i < 3; ++i) {
    const auto frame = source.Next();
    EXPECT_THAT(frame, IsOk());
    field = *tracker.Track(*DecodeGray((*frame)->view()));
    tracker.Advance();
  }
  Vectors vectors;
  for (const FlowVector& v : field->vectors) {
    const bool still = std::hypot(v.end_x - v.start_x, v.end_y - v.start_y) < 0.25;
    ++(still ? vectors.still : vectors.moving);
    vectors.on_the_bonnet += v.start_y >= kBonnet ? 1 : 0;
  }
  return vectors;
}

TEST(ViewWindowTest, WithoutAWindowTheSourceStays) {
  auto source = std::make_unique<RobotCamera>();
  const FrameSource* const before = source.get();
  const auto opened = OpenWindow(std::move(source), {});
  ASSERT_THAT(opened, IsOk());
  EXPECT_EQ(opened->get(), before);
}

TEST(ViewWindowTest, NothingIsFollowedWhereTheMaskIsBlack) {
  TemporaryFolder folder;
  RobotCamera whole;
  const Vectors without = Track(whole);
  ASSERT_GT(without.on_the_bonnet, 50);
  ViewWindow window;
  window.mask = WriteMask(folder, kWidth, kBonnet);
  const auto masked = OpenWindow(std::make_unique<RobotCamera>(), window);
  ASSERT_THAT(masked, IsOk());
  const Vectors with = Track(**masked);
  EXPECT_EQ(with.on_the_bonnet, 0);
  EXPECT_LE(with.still, 2);
  EXPECT_GT(with.moving, without.moving / 2);
}

TEST(ViewWindowTest, CropsTheImageAndItsCamera) {
  ViewWindow window;
  window.crop = CropRectangle{20, 10, 200, 100};
  const auto cropped = OpenWindow(std::make_unique<RobotCamera>(), window);
  ASSERT_THAT(cropped, IsOk());
  const auto frame = (*cropped)->Next();
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ((*frame)->width, 200);
  EXPECT_EQ((*frame)->height, 100);
  RobotCamera whole;
  const auto all = whole.Next();
  for (const int y : {0, 37, 99}) {
    EXPECT_EQ((*frame)->data.substr(static_cast<std::size_t>(y) * 200, 200),
              (*all)->data.substr(static_cast<std::size_t>((y + 10) * kWidth + 20), 200));
  }
  const Camera camera = *(*cropped)->camera();
  EXPECT_EQ(camera.width, 200);
  EXPECT_EQ(camera.height, 100);
  EXPECT_EQ(*camera.intrinsics, (Intrinsics{277, 278, 140, 110}));
}

TEST(ViewWindowTest, AFrameThatDoesNotFitHasAFault) {
  TemporaryFolder folder;
  ViewWindow window;
  window.crop = CropRectangle{200, 0, 200, 100};
  auto source = OpenWindow(std::make_unique<RobotCamera>(), window);
  EXPECT_THAT((*(*source)->Next())->fault, HasSubstr("the crop ends at 400, 100"));
  window.crop.reset();
  window.mask = WriteMask(folder, 100, kHeight);
  source = OpenWindow(std::make_unique<RobotCamera>(), window);
  EXPECT_THAT((*(*source)->Next())->fault, HasSubstr("is 100 x 240"));
}

TEST(ViewWindowTest, RefusesBadMasksAndCrops) {
  TemporaryFolder folder;
  ViewWindow window;
  window.mask = folder.File("no.png");
  EXPECT_THAT(OpenWindow(std::make_unique<RobotCamera>(), window),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("no.png")));
  window.mask = WriteMask(folder, kWidth, 0);
  EXPECT_THAT(OpenWindow(std::make_unique<RobotCamera>(), window),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("is black")));
  for (const char* text : {"", "1,2,3", "1,2,30,x", "-1,0,30,30", "0,0,15,30", "0,0,9000,30"}) {
    EXPECT_THAT(ParseCrop(text),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("X,Y,WIDTH,HEIGHT")))
        << text;
  }
  EXPECT_EQ(ParseCrop("1,2,30,40")->width, 30);
}

}  // namespace
}  // namespace homing::client
