// Videos as disks and cameras leave them.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <thread>
#include <vector>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

class CliVideoTest : public CliTest {
 protected:
  void SetUp() override { StartServer(); }
  static cv::Mat Wall(cv::Size size) {
    cv::Mat wall(size.height / 8, size.width / 2, CV_8UC3);
    cv::RNG(7).fill(wall, cv::RNG::UNIFORM, 0, 255);
    cv::resize(wall, wall, cv::Size(4 * size.width, size.height), 0, 0, cv::INTER_CUBIC);
    return wall;
  }
  // A camera that passes a rough wall. Motion JPEG: each frame stands for itself.
  void Write(const std::string& path, int frames, cv::Size size) {
    const cv::Mat wall = Wall(size);
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20,
                           size);
    ASSERT_TRUE(writer.isOpened());
    const int pixels_a_frame = size.width / 100;
    for (int i = 0; i < frames; ++i) {
      writer.write(wall(cv::Rect({i * pixels_a_frame, 0}, size)));
    }
  }
  Ran Record(const std::string& path) const {
    return Homing({"record", "--journey", kJourney, "--left", path});
  }
  nlohmann::json Shown() const {
    return Homing({"--json", "journeys", "show", kJourney}).Json().at(0);
  }
};

// Of formats with a count of frames, and with none.
class HoleTest : public CliVideoTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(HoleTest, IsReportedAndNotTheEnd) {
  constexpr int kFrames = 60;
  const std::string path = Path(std::string("hole.") + GetParam());
  Write(path, kFrames, {320, 240});
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file << std::string(size / 4, '\0');
  }
  const Ran ran = Record(path);
  EXPECT_THAT(ran.errors, HasSubstr("damaged"));
  EXPECT_EQ(Shown()["state"], ran.code == 0 ? "FINISHED" : "ACTIVE");
  EXPECT_GT(std::stoi(Shown()["step_count"].dump()), kFrames / 2);
}

INSTANTIATE_TEST_SUITE_P(Formats, HoleTest, ::testing::Values("avi", "mkv", "mov"));

// A camera is known by its first frames: it has no end, and Ctrl-C may come soon.
TEST_F(CliVideoTest, ACameraIsRecordedFromItsFirstFramesOn) {
  Write(Path("camera.mjpeg"), 50, {320, 240});
  ASSERT_LT(std::filesystem::file_size(Path("camera.mjpeg")), 1U << 20);
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  Program camera(
      {"/bin/sh", "-c",
       "{ cat '" + Path("camera.mjpeg") + "'; exec sleep 100; } >'" + Path("pipe") + "'"});
  Program recording(Command({"--json", "record", "--journey", kJourney, "--left", Path("pipe")}));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(recording.ReadLine()) << recording.Stderr();
  recording.Signal(SIGINT);
  EXPECT_EQ(recording.Wait(), 0) << recording.Stderr();
  EXPECT_EQ(Shown()["state"], "FINISHED");
  EXPECT_GE(std::stoi(Shown()["step_count"].dump()), 18);
}

// Many cameras and programs write each frame as a JPEG file with a JFIF header.
TEST_F(CliVideoTest, ACameraMaySendJpegImagesOneBehindTheOther) {
  const cv::Mat wall = Wall({320, 240});
  {
    std::ofstream film(Path("film.mjpeg"), std::ios::binary);
    for (int i = 0; i < 20; ++i) {
      std::vector<uchar> image;
      ASSERT_TRUE(cv::imencode(".jpg", wall(cv::Rect(3 * i, 0, 320, 240)), image));
      film.write(reinterpret_cast<const char*>(image.data()),
                 static_cast<std::streamsize>(image.size()));
    }
  }
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  const Program camera(
      {"/bin/sh", "-c", "cat '" + Path("film.mjpeg") + "' >'" + Path("pipe") + "'"});
  const Ran ran = Record(Path("pipe"));
  EXPECT_EQ(ran.code, 0) << ran.errors;
  EXPECT_GE(std::stoi(Shown()["step_count"].dump()), 18);
}

TEST_F(CliVideoTest, APipeThatNoProgramWritesToCanBeStopped) {
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  Program recording(Command({"record", "--journey", kJourney, "--left", Path("pipe")}));
  // Until the program handles signals.
  std::this_thread::sleep_for(std::chrono::seconds(1));
  recording.Signal(SIGINT);
  EXPECT_EQ(recording.Wait(), 1);
  EXPECT_THAT(recording.Stderr(), HasSubstr("stopped"));
}

TEST_F(CliVideoTest, OneThatEndsTooEarlyIsAnErrorAndTheJourneyNotFinished) {
  const std::string path = Path("cut.avi");
  Write(path, 60, {320, 240});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Ran ran = Record(path);
  if (ran.code == 0) {
    // Without its index the file promises no more than it has.
    EXPECT_EQ(Shown()["state"], "FINISHED");
    GTEST_SKIP() << "SKIPPED: this FFmpeg takes the length from the file";
  }
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.errors, AnyOf(HasSubstr("damaged"), HasSubstr("frames can be read")));
  EXPECT_EQ(Shown()["state"], "ACTIVE");
}

TEST_F(CliVideoTest, FourThousandPixelsAreNotTooMany) {
  const std::string path = Path("large.avi");
  Write(path, 3, {3840, 2160});
  const Ran ran = Record(path);
  EXPECT_EQ(ran.code, 0) << ran.errors;
  EXPECT_EQ(Shown()["step_count"], 2);
}

}  // namespace
}  // namespace homing
