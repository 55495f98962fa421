// Shi-Tomasi corners by an absolute threshold, one a cell. Source: paper II-B, eqs 3 to 5 (A^T A
// must be well conditioned). The threshold is absolute and suppression works by cells, so that a
// bright sign does not change the count elsewhere.
#ifndef HOMING_FLOW_CORNER_DETECTOR_H_
#define HOMING_FLOW_CORNER_DETECTOR_H_

#include <opencv2/core.hpp>
#include <vector>

#include "homing/flow/flow_tracker.h"

namespace homing {

// Intermediate images, reused for the next frame of the same size.
struct CornerBuffers {
  cv::Mat strength;
  cv::Mat strongest;
};

// Corners of a normalised image (CV_32FC1), working pixels, row by row of cells. No two are nearer
// than half a cell, and there are no more than kMostWindowPixels allows. `enlargement` is working
// size over source size, 1 if the image was shrunk.
std::vector<cv::Point2f> DetectCorners(const cv::Mat& normalized, const FlowOptions& options,
                                       double enlargement, CornerBuffers* buffers);
std::vector<cv::Point2f> DetectCorners(const cv::Mat& normalized, const FlowOptions& options,
                                       double enlargement = 1);

}  // namespace homing

#endif  // HOMING_FLOW_CORNER_DETECTOR_H_
