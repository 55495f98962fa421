#include "tests/benchmark/textured_drive.h"

#include <opencv2/imgproc.hpp>
#include <random>

namespace homing::benchmarks {
namespace {

constexpr double kPixelsAFrame = 3.4;

cv::Mat DrawWall(cv::Size size) {
  cv::RNG random(7);
  cv::Mat fine(size, CV_32F);
  cv::Mat coarse(size, CV_32F);
  random.fill(fine, cv::RNG::NORMAL, 0, 90);
  random.fill(coarse, cv::RNG::NORMAL, 0, 900);
  cv::GaussianBlur(fine, fine, {}, 1.5);
  cv::GaussianBlur(coarse, coarse, {}, 12);
  cv::Mat wall = fine + coarse + 128;
  // A blank stretch after each textured one.
  for (int x = 0; x < wall.cols; x += 400) {
    wall.colRange(x, std::min(wall.cols, x + 120)).setTo(128);
  }
  return wall;
}

}  // namespace

std::vector<cv::Mat> DrawFrames(cv::Size size, int count) {
  const int length = size.width + static_cast<int>(kPixelsAFrame * count) + 2;
  const cv::Mat wall = DrawWall({length, size.height});
  cv::RNG random(11);
  std::vector<cv::Mat> frames;
  for (int i = 0; i < count; ++i) {
    cv::Mat view;
    const float x = static_cast<float>(size.width - 1) / 2 + static_cast<float>(kPixelsAFrame * i);
    const float y = static_cast<float>(size.height - 1) / 2;
    cv::getRectSubPix(wall, size, {x, y}, view);
    cv::Mat noise(size, CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0, 2);
    cv::Mat frame;
    cv::Mat(view + noise).convertTo(frame, CV_8U);
    frames.push_back(frame);
  }
  return frames;
}

Observation FrameObservation(std::int64_t sequence, const cv::Mat& frame) {
  Observation observation;
  observation.sequence = sequence;
  observation.views[0] = Frame{FrameEncoding::kGray8,
                               frame.cols,
                               frame.rows,
                               {reinterpret_cast<const char*>(frame.data), frame.total()}};
  return observation;
}

Observation FlowObservation(std::int64_t sequence, int vectors) {
  std::mt19937 random(static_cast<std::uint32_t>(sequence));
  std::uniform_real_distribution<float> spread(-25, 25);
  FlowField field{640, 480, {}};
  for (int i = 0; i < vectors; ++i) {
    const float center = i % 2 == 0 ? 130.0F : 470.0F;
    const float x = center + spread(random) + static_cast<float>(sequence % 40);
    const float y = 240 + 3 * spread(random);
    field.vectors.push_back({x, y, x - 4, y + 0.25F});
  }
  Observation observation;
  observation.sequence = sequence;
  observation.views[0] = field;
  return observation;
}

}  // namespace homing::benchmarks
