// Exact flow between two views.
#ifndef CLIENT_SIMULATOR_TRUE_FLOW_H_
#define CLIENT_SIMULATOR_TRUE_FLOW_H_

#include <opencv2/core.hpp>

#include "client/simulator/view.h"

namespace homing::client {

// CV_32FC2, pixels: where the point seen at each pixel of `from` went in `to`. NaN: sky, hidden in
// `to`, or out of its image.
cv::Mat FlowBetween(const View& from, const View& to);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_TRUE_FLOW_H_
