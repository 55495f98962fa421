// Frames past a textured wall, the same at every run.
#ifndef TESTS_BENCHMARK_TEXTURED_DRIVE_H_
#define TESTS_BENCHMARK_TEXTURED_DRIVE_H_

#include <opencv2/core.hpp>
#include <vector>

#include "homing/flow/observation.h"

namespace homing::benchmarks {

// Grey images of a camera that slides along; textured and blank parts take turns.
std::vector<cv::Mat> DrawFrames(cv::Size size, int count);

// One camera's observation of a frame; the frame must outlive it.
Observation FrameObservation(std::int64_t sequence, const cv::Mat& frame);

// One camera's observation of `vectors` flow vectors in one or two clusters that drift.
Observation FlowObservation(std::int64_t sequence, int vectors);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_TEXTURED_DRIVE_H_
