// The same frames give the same map, whatever kind of file they come in.
#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "server/service/journey_archive.h"
#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

constexpr int kDriveFrames = 14;

class CliSameMapTest : public CliTest {
 protected:
  void SetUp() override {
    StartServer();
    RunWell({HOMING_PROGRAM, "simulate", "--scene", "street,length=3", "--out", Path("drive")});
    folder_map_ = MapOf(Path("drive/left"), Path("drive/right"));
    ASSERT_FALSE(folder_map_.empty());
  }
  static void RunWell(const std::vector<std::string>& command) {
    const Ran ran = Run(command);
    ASSERT_EQ(ran.code, 0) << ran.errors;
  }
  // Lossless, grey: FFV1 as `ffmpeg -c:v ffv1 -pix_fmt gray` writes it.
  std::string Video(const std::string& camera) const {
    std::string path = Path(camera + ".mkv");
    std::vector<std::string> frames;
    for (const auto& entry : std::filesystem::directory_iterator(Path("drive/" + camera))) {
      frames.push_back(entry.path());
    }
    std::sort(frames.begin(), frames.end());
    EXPECT_EQ(frames.size(), std::size_t{kDriveFrames});
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 10,
                           cv::imread(frames.at(0)).size(), /*isColor=*/false);
    EXPECT_TRUE(writer.isOpened());
    for (const std::string& frame : frames) writer.write(cv::imread(frame, cv::IMREAD_GRAYSCALE));
    return path;
  }
  // The exported map but for start and end time.
  std::string MapOf(const std::string& left, const std::string& right) const {
    const std::string journey = "robots/a/journeys/j" + std::to_string(++journeys_);
    const Ran ran = Homing({"record", "--journey", journey, "--left", left, "--right", right});
    EXPECT_EQ(ran.code, 0) << ran.errors;
    auto exported = server::DecodeJourney(Export(journey));
    EXPECT_TRUE(exported.ok()) << exported.status();
    if (!exported.ok()) return "";
    EXPECT_EQ(exported->map.step_count(), kDriveFrames - 1);
    EXPECT_GT(exported->map.all_fingerprints().size(), std::size_t{kDriveFrames});
    exported->record.start_time_ns = exported->record.end_time_ns = 0;
    return *server::EncodeJourney(exported->record, exported->map);
  }

  mutable int journeys_ = 0;
  std::string folder_map_;
};

TEST_F(CliSameMapTest, OfBagsOfEachFormat) {
  RunWell({"/usr/bin/python3", MAKE_BAGS, Path("drive"), Path("bags")});
  RunWell({"/usr/bin/python3", MAKE_BAGS, "--png", Path("drive"), Path("compressed")});
  for (const char* name :
       {"none.mcap", "zstd.mcap", "lz4.mcap", "none.bag", "bz2.bag", "lz4.bag", "rosbag2.db3"}) {
    EXPECT_EQ(MapOf(Path("bags/") + name, Path("bags/") + name), folder_map_) << name;
    EXPECT_EQ(MapOf(Path("compressed/") + name, Path("compressed/") + name), folder_map_) << name;
  }
}

TEST_F(CliSameMapTest, OfALosslessGreyVideo) {
  EXPECT_EQ(MapOf(Video("left"), Video("right")), folder_map_);
}

}  // namespace
}  // namespace homing
