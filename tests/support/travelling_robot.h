// A robot for tests of the pipelines: two cameras slide past an endless textured wall each, or give
// flow vectors made up of clusters. Deterministic.
#ifndef TESTS_SUPPORT_TRAVELLING_ROBOT_H_
#define TESTS_SUPPORT_TRAVELLING_ROBOT_H_

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "homing/flow/observation.h"

namespace homing {

// The observations of one drive; owns the pixels that they point to.
class TravellingRobot {
 public:
  static constexpr int kWidth = 160;
  static constexpr int kHeight = 120;
  static constexpr int kPixelsPerFrame = 3;

  // Frames past a wall of noise, textured in patches; the cameras move opposite ways.
  static TravellingRobot WithFrames(int count, std::uint64_t seed) {
    TravellingRobot robot;
    const cv::Mat wall = Wall(kWidth + kPixelsPerFrame * count, seed);
    for (int i = 0; i < count; ++i) {
      const int at = kPixelsPerFrame * i;
      robot.AddFrames(wall.colRange(at, at + kWidth),
                      wall.colRange(wall.cols - kWidth - at, wall.cols - at));
    }
    return robot;
  }

  // Flow vectors of one or two clusters a camera that drift across the image.
  static TravellingRobot WithFlowVectors(int count, std::uint64_t seed) {
    TravellingRobot robot;
    std::mt19937_64 engine(seed);
    for (int i = 0; i < count; ++i) {
      Observation observation;
      observation.sequence = i;
      observation.views = {Clusters(i, -4, engine), Clusters(i + 7, 4, engine)};
      robot.observations_.push_back(observation);
    }
    return robot;
  }

  const std::vector<Observation>& observations() const { return observations_; }
  std::vector<Observation>& mutable_observations() { return observations_; }

 private:
  static cv::Mat Wall(int width, std::uint64_t seed) {
    cv::Mat wall(kHeight, width, CV_8UC1);
    std::mt19937_64 engine(seed);
    for (int y = 0; y < wall.rows; ++y) {
      for (int x = 0; x < wall.cols; ++x) {
        // Blank and textured patches take turns, so that landmarks come and go.
        const bool textured = (x / 60 + static_cast<int>(seed)) % 2 == 0;
        wall.at<unsigned char>(y, x) = textured ? static_cast<unsigned char>(engine() % 256) : 128;
      }
    }
    cv::GaussianBlur(wall, wall, cv::Size(7, 7), 1.5);
    return wall;
  }

  static FlowField Clusters(int step, float flow, std::mt19937_64& engine) {
    FlowField field{.width = kWidth, .height = kHeight, .vectors = {}};
    for (int cluster = 0; cluster < 2; ++cluster) {
      const float drift = std::fmod(static_cast<float>(step) * std::abs(flow), 80.0F);
      const float x = flow > 0 ? 5 + drift + 65 * static_cast<float>(cluster)
                               : 85 - drift + 65 * static_cast<float>(cluster);
      const int vectors = 12 + static_cast<int>(engine() % 20);
      for (int v = 0; v < vectors; ++v) {
        const float start_x = x + static_cast<float>(engine() % 8);
        const float start_y = 40 + static_cast<float>(engine() % 30);
        field.vectors.push_back({start_x, start_y, start_x + flow, start_y});
      }
    }
    return field;
  }

  void AddFrames(const cv::Mat& left, const cv::Mat& right) {
    Observation observation;
    observation.sequence = static_cast<std::int64_t>(observations_.size());
    observation.views = {Keep(left), Keep(right)};
    observations_.push_back(observation);
  }

  Frame Keep(const cv::Mat& image) {
    const cv::Mat whole = image.clone();
    pixels_.push_back(whole);
    return {FrameEncoding::kGray8, whole.cols, whole.rows,
            std::string_view(reinterpret_cast<const char*>(whole.data), whole.total())};
  }

  std::vector<cv::Mat> pixels_;
  std::vector<Observation> observations_;
};

}  // namespace homing

#endif  // TESTS_SUPPORT_TRAVELLING_ROBOT_H_
