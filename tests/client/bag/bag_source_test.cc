#include "client/bag/bag_source.h"

#include <gtest/gtest.h>

#include "client/camera_observations.h"
#include "tests/client/bag/test_bags.h"
#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::int64_t kStartNs = 1'000'000'000'000;

// Grey pixels of a frame, however it is encoded.
std::string Gray(const SourceFrame& frame) {
  DecodeLimits limits;
  limits.min_side_px = 2;
  const auto gray = DecodeGray(frame.view(), limits);
  if (!gray.ok()) return std::string(gray.status().message());
  return {reinterpret_cast<const char*>(gray->data), gray->total()};
}

class EveryBagTest : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryBagTest, GivesTheFramesOfBothCameras) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto source = OpenBagSource({BagPath(GetParam()), ""}, side);
    ASSERT_THAT(source, IsOk());
    EXPECT_EQ((*source)->size(), kFrames);
    EXPECT_EQ((*source)->remark(), "");
    for (int i = 0; i < kFrames; ++i) {
      const auto frame = (*source)->Next();
      ASSERT_THAT(frame, IsOk());
      ASSERT_TRUE(frame->has_value());
      EXPECT_EQ(Gray(**frame), Pixels(i, side == Side::kRight)) << i;
      EXPECT_EQ((*frame)->capture_time_ns, kStartNs + i * 100'000'000);
    }
    const auto end = (*source)->Next();
    ASSERT_THAT(end, IsOk());
    EXPECT_FALSE(end->has_value());
  }
}

TEST_P(EveryBagTest, FramesArePairedByTheirStamps) {
  const auto source = OpenBagSource({BagPath(GetParam()), ""}, Side::kRight);
  ASSERT_THAT(source, IsOk());
  const FrameKeys keys = (*source)->keys();
  EXPECT_EQ(keys.kind, FrameKeys::Kind::kTime);
  ASSERT_EQ(keys.values.size(), std::size_t{kFrames});
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(keys.values[static_cast<std::size_t>(i)], kStartNs + i * 100'000'000);
  }
}

TEST_P(EveryBagTest, SeeksToAnyFrame) {
  const auto source = OpenBagSource({BagPath(GetParam()), "/cam/left/image_raw"}, Side::kRight);
  ASSERT_THAT(source, IsOk());
  for (const int frame : {7, 0, 11, 3}) {
    ASSERT_TRUE((*source)->Seek(frame));
    EXPECT_EQ(Gray(**(*source)->Next()), Pixels(frame, false));
  }
  EXPECT_FALSE((*source)->Seek(kFrames + 1));
  EXPECT_FALSE((*source)->Seek(-1));
}

TEST_P(EveryBagTest, CameraInfoSetsTheCamera) {
  const std::string name = GetParam();
  const auto left = OpenBagSource({BagPath(name), ""}, Side::kLeft);
  const auto right = OpenBagSource({BagPath(name), ""}, Side::kRight);
  ASSERT_THAT(left, IsOk());
  ASSERT_THAT(right, IsOk());
  EXPECT_FALSE((*right)->camera().has_value());
  const bool has_info = name != "ros1.mcap" && name != "foxglove.mcap";
  ASSERT_EQ((*left)->camera().has_value(), has_info);
  if (!has_info) return;
  const Camera camera = *(*left)->camera();
  EXPECT_EQ(camera.width, 8);
  EXPECT_EQ(camera.height, 6);
  EXPECT_EQ(*camera.intrinsics, (Intrinsics{7, 7.5, 4, 3}));
  EXPECT_EQ(camera.distortion[0], -0.25);
  EXPECT_EQ(camera.distortion[1], 0.0625);
}

// The number of its coefficients is far too large.
TEST(BagSourceTest, ADamagedCameraInfoIsNamed) {
  TemporaryFolder folder;
  std::string bytes = ReadFile(BagPath("none.bag"));
  const std::string model("\x09\0\0\0plumb_bob", 13);
  bytes[bytes.find(model) + model.size() + 3] = 0x7f;
  WriteFile(folder.File("a.bag"), bytes);
  EXPECT_THAT(OpenBagSource({folder.File("a.bag"), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kDataLoss, AllOf(HasSubstr("a.bag#/cam/left/camera_info"),
                                                          HasSubstr("not a complete"))));
}

INSTANTIATE_TEST_SUITE_P(Bags, EveryBagTest, ::testing::ValuesIn(kBags),
                         [](const auto& bag) { return TestName(bag.param); });

TEST(BagSourceTest, NamesOfBags) {
  EXPECT_FALSE(ParseBagName("folder").has_value());
  EXPECT_FALSE(ParseBagName("film.mp4").has_value());
  EXPECT_EQ(ParseBagName("a.bag")->path, "a.bag");
  EXPECT_EQ(ParseBagName("a.bag")->topic, "");
  EXPECT_EQ(ParseBagName("d#1/a.mcap#/c/d")->path, "d#1/a.mcap");
  EXPECT_EQ(ParseBagName("d#1/a.mcap#/c/d")->topic, "/c/d");
  EXPECT_EQ(ParseBagName("a.db3#/c")->topic, "/c");
  EXPECT_EQ(ParseBagName("mcap:a.rec")->path, "a.rec");
  EXPECT_EQ(ParseBagName("mcap:a.rec#/c")->topic, "/c");
}

TEST(BagSourceTest, AWrongTopicListsThoseThatThereAre) {
  const auto source = OpenBagSource({BagPath("zstd.mcap"), "/cam/front"}, Side::kLeft);
  EXPECT_THAT(source,
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("zstd.mcap"), HasSubstr("/cam/front"),
                             HasSubstr("/cam/left/image_raw  sensor_msgs/msg/Image, 12 messages, "
                                       "10.0 Hz"),
                             HasSubstr("/cam/right/image_raw"))));
}

TEST(BagSourceTest, SaysWhatIsWrongWithAFile) {
  TemporaryFolder folder;
  EXPECT_THAT(OpenBagSource({folder.File("none.bag"), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("No such file")));
  WriteFile(folder.File("text.bag"), "some text");
  EXPECT_THAT(OpenBagSource({folder.File("text.bag"), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("neither")));
  WriteFile(folder.File("empty.bag"), "");
  EXPECT_THAT(OpenBagSource({folder.File("empty.bag"), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("is empty")));
  WriteFile(folder.File("old.bag"), "#ROSBAG V1.2\n");
  EXPECT_THAT(OpenBagSource({folder.File("old.bag"), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("old version")));
  WriteFile(folder.File("packed.db3"), "\x28\xb5\x2f\xfd...");
  EXPECT_THAT(OpenBagSource({folder.File("packed.db3"), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("zstd -d")));
  EXPECT_THAT(OpenBagSource({folder.File(""), ""}, Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("regular file")));
}

// rosbag2 can record with a write-ahead log: numbers 2 in the file's head. The name is no URI.
TEST(BagSourceTest, ADatabaseWithALogNeedsNoFileBesideIt) {
  TemporaryFolder folder;
  std::string bytes = ReadFile(BagPath("rosbag2.db3"));
  bytes[18] = bytes[19] = 2;
  WriteFile(folder.File("a?b%20#c.db3"), bytes);
  const auto source = OpenBagSource({folder.File("a?b%20#c.db3"), ""}, Side::kLeft);
  ASSERT_THAT(source, IsOk());
  ASSERT_THAT((*source)->Next(), IsOk());
  const std::filesystem::directory_iterator files(folder.File(""));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

// As rosbag2 leaves them.
TEST(BagSourceTest, AFolderWithOneBagIsThatBag) {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.File("drive"));
  WriteFile(folder.File("drive/metadata.yaml"), "rosbag2_bagfile_information:");
  std::filesystem::copy_file(BagPath("rosbag2.db3"), folder.File("drive/drive_0.db3"));
  EXPECT_THAT(OpenCameras(folder.File("drive"), folder.File("drive")), IsOk());
  std::filesystem::copy_file(BagPath("rosbag2.db3"), folder.File("drive/drive_1.db3"));
  EXPECT_THAT(OpenCameras(folder.File("drive"), "").status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("2 bags"), HasSubstr("drive_0.db3"))));
}

TEST(BagSourceTest, OneTopicIsNotForBothCameras) {
  const std::string left = BagPath("none.bag") + "#/cam/left/image_raw";
  EXPECT_THAT(OpenCameras(left, BagPath("none.bag")), IsOk());
  EXPECT_THAT(OpenCameras(left, left).status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("two topics")));
}

}  // namespace
}  // namespace homing::client::bag
