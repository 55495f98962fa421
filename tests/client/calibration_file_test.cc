#include "client/calibration_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::client {
namespace {

using ::testing::_;
using ::testing::AllOf;
using ::testing::HasSubstr;

using Distortion = std::array<double, 8>;

class CalibrationFileTest : public ::testing::Test {
 protected:
  absl::StatusOr<Camera> Read(const std::string& text, const std::string& camera = "") {
    std::ofstream(folder_.File("c.yaml"), std::ios::binary | std::ios::trunc) << text;
    return ReadCalibrationFile(folder_.File("c.yaml") + camera);
  }
  TemporaryFolder folder_;
};

constexpr char kRos[] = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [438.5, 0.0, 305.25, 0.0, 437.5, 238.75, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, 0.125, 0.001, -0.002, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [393, 0, 322, 0, 0, 393, 241, 0, 0, 0, 1, 0]
)";

TEST_F(CalibrationFileTest, ReadsCameraInfoOfRos) {
  const auto camera = Read(kRos);
  ASSERT_THAT(camera, IsOk());
  EXPECT_EQ(camera->width, 640);
  EXPECT_EQ(camera->height, 480);
  EXPECT_EQ(*camera->intrinsics, (Intrinsics{438.5, 437.5, 305.25, 238.75}));
  EXPECT_EQ(camera->distortion, (Distortion{-0.25, 0.125, 0.001, -0.002}));
  EXPECT_FALSE(camera->fisheye);
  // As other programs write YAML.
  EXPECT_EQ(*Read(std::string("---\n") + kRos), *camera);
  EXPECT_EQ(*Read(std::string("%YAML 1.1\n---\n") + kRos), *camera);
}

TEST_F(CalibrationFileTest, ReadsTheRationalAndTheFisheyeModelOfRos) {
  const std::string text = kRos;
  const std::size_t at = text.find("distortion_model");
  const std::string head = text.substr(0, at);
  const auto rational = Read(head +
                             "distortion_model: rational_polynomial\n"
                             "distortion_coefficients:\n  rows: 1\n  cols: 8\n"
                             "  data: [0.5, -0.25, 0.001, 0.002, 0.03, 0.75, -0.125, 0.0625]\n");
  ASSERT_THAT(rational, IsOk());
  EXPECT_EQ(rational->distortion,
            (Distortion{0.5, -0.25, 0.001, 0.002, 0.03, 0.75, -0.125, 0.0625}));
  const auto fisheye =
      Read(head +
           "distortion_model: equidistant\n"
           "distortion_coefficients: {rows: 1, cols: 4, data: [0.1, 0.2, 0.3, 0.4]}\n");
  ASSERT_THAT(fisheye, IsOk());
  EXPECT_TRUE(fisheye->fisheye);
  EXPECT_EQ(fisheye->distortion, (Distortion{0.1, 0.2, 0.3, 0.4}));
}

constexpr char kKalibr[] = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.8e-05]
  distortion_model: radtan
  intrinsics: [458.5, 457.25, 367.25, 248.5]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.999, 0.002, 0.001, -0.11]
  - [-0.002, 0.999, 0.01, 0.0004]
  - [-0.001, -0.01, 0.999, -0.0008]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: pinhole
  distortion_coeffs: [0.01, -0.02, 0.03, -0.04]
  distortion_model: equidistant
  intrinsics: [190.5, 191.5, 254.75, 256.5]
  resolution: [512, 500]
  rostopic: /cam1/image_raw
)";

TEST_F(CalibrationFileTest, ReadsTheCamerasOfKalibr) {
  const auto first = Read(kKalibr, "#cam0");
  ASSERT_THAT(first, IsOk());
  EXPECT_EQ(first->width, 752);
  EXPECT_EQ(*first->intrinsics, (Intrinsics{458.5, 457.25, 367.25, 248.5}));
  EXPECT_EQ(first->distortion, (Distortion{-0.28, 0.07, 0.0002, 1.8e-05}));
  EXPECT_FALSE(first->fisheye);
  const auto second = Read(kKalibr, "#cam1");
  ASSERT_THAT(second, IsOk());
  EXPECT_EQ(second->height, 500);
  EXPECT_EQ(*second->intrinsics, (Intrinsics{190.5, 191.5, 254.75, 256.5}));
  EXPECT_TRUE(second->fisheye);
  EXPECT_EQ(second->distortion, (Distortion{0.01, -0.02, 0.03, -0.04}));
  EXPECT_THAT(Read(kKalibr), StatusIs(absl::StatusCode::kInvalidArgument,
                                      AllOf(HasSubstr("2 cameras"), HasSubstr("#cam0"))));
  const std::string text = kKalibr;
  EXPECT_EQ(*Read(text.substr(0, text.find("cam1:"))), *first);
  std::string omni = text;
  omni.replace(omni.find("pinhole"), 7, "omni");
  EXPECT_THAT(Read(omni, "#cam0"), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("omni")));
}

TEST_F(CalibrationFileTest, ReadsYamlOfOpenCv) {
  const auto camera = Read(R"(%YAML:1.0
---
calibration_time: "Thu 01 Jan 2026"
image_width: 320
image_height: 240
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 277.5, 0., 159.5, 0., 278.5, 119.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -3.0e-01, 8.0e-02, 1.0e-03, -2.0e-03, 1.0e-02 ]
)");
  ASSERT_THAT(camera, IsOk());
  EXPECT_EQ(camera->width, 320);
  EXPECT_EQ(*camera->intrinsics, (Intrinsics{277.5, 278.5, 159.5, 119.5}));
  EXPECT_EQ(camera->distortion, (Distortion{-0.3, 0.08, 0.001, -0.002, 0.01}));
}

TEST_F(CalibrationFileTest, ReadsXmlOfOpenCv) {
  const auto camera = Read(R"(<?xml version="1.0"?>
<opencv_storage>
<image_width>320</image_width>
<image_height>240</image_height>
<fisheye_model>1</fisheye_model>
<camera_matrix type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    277.5 0. 159.5 0. 278.5 119.5 0. 0. 1.</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix">
  <rows>4</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    0.125 -0.25 0.5 -0.75</data></distortion_coefficients>
</opencv_storage>
)");
  ASSERT_THAT(camera, IsOk());
  EXPECT_EQ(camera->height, 240);
  EXPECT_EQ(*camera->intrinsics, (Intrinsics{277.5, 278.5, 159.5, 119.5}));
  EXPECT_TRUE(camera->fisheye);
  EXPECT_EQ(camera->distortion, (Distortion{0.125, -0.25, 0.5, -0.75}));
}

// OpenCV's parser followed a null pointer.
TEST_F(CalibrationFileTest, ABrokenHeadOfXmlIsRefused) {
  const std::string text =
      "<?xml veriosn=" + std::string(16, '\0') + "\xff\"?>\n<opencv_storage>\n<image_width>320</im";
  EXPECT_THAT(Read(text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("c.yaml")));
}

// Each once overflowed the stack.
TEST_F(CalibrationFileTest, DeepAndEndlessTreesAreRefused) {
  const auto repeated = [](const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  };
  const std::string head = "<?xml version=\"1.0\"?><opencv_storage>";
  for (const std::string& text :
       {std::string("a: &a [*a]"), repeated("[", 60'000), head + repeated("<a>", 200'000),
        head + repeated("<a>", 900) + "1" + repeated("</a>", 900) + "</opencv_storage>"}) {
    EXPECT_THAT(Read(text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("c.yaml")));
  }
}

TEST_F(CalibrationFileTest, SaysWhatIsWrong) {
  EXPECT_THAT(ReadCalibrationFile("/no/such.yaml"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/no/such.yaml: No such file")));
  for (const char* text :
       {"", "some text", "a: [1, 2", "<a>", "{", "image_width: 640\n", "- 1\n"}) {
    EXPECT_THAT(Read(text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("c.yaml")))
        << text;
  }
  std::string text = kRos;
  text.replace(text.find("plumb_bob"), 9, "thin_lens");
  EXPECT_THAT(Read(text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("thin_lens")));
  // The coefficients behind it would move to its place.
  text = kRos;
  text.replace(text.find("0.125"), 5, "0,125x");
  EXPECT_THAT(Read(text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("125x")));
  text = kRos;
  text.replace(text.find("438.5"), 5, "-4385");
  EXPECT_THAT(Read(text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("focal length")));
}

}  // namespace
}  // namespace homing::client
