#include "client/bag/image_message.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

const BagTopic kTopic = {
    "/cam/camera_info", "sensor_msgs/CameraInfo", Wire::kRos1, Content::kCameraInfo, {}};

// Fields of ROS 1, little endian.
class Message {
 public:
  template <typename Number>
  Message& Add(Number number) {
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &number, raw.size());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  Message& Text(const std::string& text) {
    Add(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  template <std::size_t count>
  Message& Doubles(const std::array<double, count>& values) {
    for (const double value : values) Add(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// A sensor of 1280 x 960 pixels, up to its field P.
Message Sensor(const std::array<double, 9>& k) {
  Message message;
  message.Add(0U).Add(1000U).Add(0U).Text("camera").Add(960U).Add(1280U).Text("plumb_bob");
  message.Add(5U).Doubles(std::array{-0.25, 0.0625, 0.0, 0.0, 0.0}).Doubles(k);
  message.Doubles(std::array{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  message.Doubles(std::array{800.0, 0.0, 650.0, -80.0, 0.0, 780.0, 500.0, 0.0, 0.0, 0.0, 1.0, 0.0});
  return message;
}

constexpr std::array<double, 9> kMatrix = {900, 0, 640, 0, 880, 480, 0, 0, 1};

Camera CameraOf(const Message& message, bool rectified = false) {
  const auto info = DecodeCameraInfo(kTopic, message.bytes());
  EXPECT_THAT(info, IsOk());
  const auto camera = ToCamera(*info, rectified);
  EXPECT_THAT(camera, IsOk());
  return camera.value_or(Camera());
}

TEST(CameraInfoMessageTest, DescribesTheWholeSensorWithoutBinningAndRegion) {
  for (const std::uint32_t binning : {0U, 1U}) {
    Message message = Sensor(kMatrix);
    message.Add(binning).Add(binning).Add(0U).Add(0U).Add(0U).Add(0U).Add(std::uint8_t{0});
    const Camera camera = CameraOf(message);
    EXPECT_EQ(camera.width, 1280);
    EXPECT_EQ(camera.height, 960);
    EXPECT_EQ(*camera.intrinsics, (Intrinsics{900, 880, 640, 480}));
  }
}

// Two by four pixels of the sensor make one.
TEST(CameraInfoMessageTest, BinningMakesTheImageSmaller) {
  Message message = Sensor(kMatrix);
  message.Add(2U).Add(4U).Add(0U).Add(0U).Add(0U).Add(0U).Add(std::uint8_t{0});
  const Camera raw = CameraOf(message);
  EXPECT_EQ(raw.width, 640);
  EXPECT_EQ(raw.height, 240);
  EXPECT_EQ(*raw.intrinsics, (Intrinsics{450, 220, 320, 120}));
  EXPECT_EQ(raw.distortion[0], -0.25);
  EXPECT_EQ(*CameraOf(message, true).intrinsics, (Intrinsics{400, 195, 325, 125}));
}

// The 600 x 400 pixels of the sensor from (200, 100) on, two by two in one.
TEST(CameraInfoMessageTest, ARegionMovesTheCentre) {
  Message message = Sensor(kMatrix);
  message.Add(2U).Add(2U).Add(200U).Add(100U).Add(400U).Add(600U).Add(std::uint8_t{1});
  const Camera raw = CameraOf(message);
  EXPECT_EQ(raw.width, 300);
  EXPECT_EQ(raw.height, 200);
  EXPECT_EQ(*raw.intrinsics, (Intrinsics{450, 440, 220, 190}));
  EXPECT_EQ(*CameraOf(message, true).intrinsics, (Intrinsics{400, 390, 225, 200}));
}

TEST(CameraInfoMessageTest, AnUncalibratedCameraStaysOne) {
  Message message = Sensor({});
  message.Add(2U).Add(2U).Add(200U).Add(100U).Add(400U).Add(600U).Add(std::uint8_t{1});
  const auto info = DecodeCameraInfo(kTopic, message.bytes());
  ASSERT_THAT(info, IsOk());
  EXPECT_EQ(info->matrix, std::vector<double>(9, 0));
}

TEST(CameraInfoMessageTest, OneThatIsCutIsRefused) {
  const std::string bytes = Sensor(kMatrix).bytes();
  EXPECT_THAT(DecodeCameraInfo(kTopic, bytes), IsOk());
  EXPECT_THAT(DecodeCameraInfo(kTopic, bytes.substr(0, bytes.size() - 1)),
              StatusIs(absl::StatusCode::kDataLoss, ::testing::HasSubstr("not a complete")));
}

}  // namespace
}  // namespace homing::client::bag
