#include "client/bag/topic_choice.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

BagTopic Topic(const std::string& name, const std::string& type) {
  const std::string full = "sensor_msgs/msg/" + type;
  BagTopic topic{name, full, Wire::kCdr, ContentOf(full, Wire::kCdr), {}};
  topic.messages.resize(3);
  topic.messages[2].time_ns = 1'000'000'000;
  return topic;
}

std::string Chosen(const std::vector<BagTopic>& topics, Side side) {
  const auto chosen = ChooseImageTopic(topics, "", side);
  return chosen.ok() ? (*chosen)->name : "";
}

TEST(TopicChoiceTest, TakesTheOnlyOne) {
  const std::vector<BagTopic> topics = {Topic("/imu", "Imu"), Topic("/image", "Image")};
  EXPECT_EQ(Chosen(topics, Side::kLeft), "/image");
  EXPECT_EQ(Chosen(topics, Side::kRight), "/image");
}

TEST(TopicChoiceTest, TakesTheSideThatTheNameSays) {
  const std::vector<BagTopic> topics = {Topic("/front/image", "Image"),
                                        Topic("/cam_left/image", "CompressedImage"),
                                        Topic("/Right/image", "Image")};
  EXPECT_EQ(Chosen(topics, Side::kLeft), "/cam_left/image");
  EXPECT_EQ(Chosen(topics, Side::kRight), "/Right/image");
  EXPECT_EQ(Chosen({topics[2]}, Side::kLeft), "");
  EXPECT_EQ(Chosen({Topic("/bright/image", "Image")}, Side::kLeft), "/bright/image");
}

TEST(TopicChoiceTest, CompressedTwinsAndDepthDoNotCount) {
  const std::vector<BagTopic> topics = {Topic("/c/image", "Image"),
                                        Topic("/c/image/compressed", "CompressedImage"),
                                        Topic("/c/image/compressedDepth", "CompressedImage")};
  EXPECT_EQ(Chosen(topics, Side::kLeft), "/c/image");
  EXPECT_EQ(Chosen({topics[1], topics[2]}, Side::kLeft), "/c/image/compressed");
  EXPECT_EQ((*ChooseImageTopic(topics, "/c/image/compressed", Side::kLeft))->name,
            "/c/image/compressed");
}

TEST(TopicChoiceTest, ListsThemWhereItIsNotClear) {
  const std::vector<BagTopic> topics = {Topic("/a", "Image"), Topic("/b", "Image"),
                                        Topic("/imu", "Imu")};
  EXPECT_THAT(ChooseImageTopic(topics, "", Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("/a  sensor_msgs/msg/Image, 3 messages, 2.0 Hz"),
                             HasSubstr("/b"), Not(HasSubstr("/imu")))));
  EXPECT_THAT(ChooseImageTopic({topics[2]}, "", Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("no image topic"), HasSubstr("/imu"))));
  EXPECT_THAT(ChooseImageTopic({}, "", Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, "it has no topics"));
}

TEST(TopicChoiceTest, TimesMayBeFarApart) {
  BagTopic damaged = Topic("/a", "Image");
  damaged.messages[0].time_ns = std::numeric_limits<std::int64_t>::min();
  damaged.messages[2].time_ns = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(ChooseImageTopic({damaged, Topic("/b", "Image")}, "", Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("0.0 Hz")));
}

TEST(TopicChoiceTest, FindsTheCameraBesideTheImage) {
  const std::vector<BagTopic> topics = {Topic("/l/camera_info", "CameraInfo"),
                                        Topic("/r/camera_info", "CameraInfo")};
  EXPECT_EQ(FindCameraInfo(topics, Topic("/r/image_raw", "Image"))->name, "/r/camera_info");
  EXPECT_EQ(FindCameraInfo(topics, Topic("/l/image/compressed", "CompressedImage"))->name,
            "/l/camera_info");
  EXPECT_EQ(FindCameraInfo(topics, Topic("/f/image", "Image")), nullptr);
  EXPECT_TRUE(IsRectified(Topic("/l/image_rect_color", "Image")));
  EXPECT_FALSE(IsRectified(Topic("/l/image_raw", "Image")));
}

}  // namespace
}  // namespace homing::client::bag
