// Draws the flow vectors of a frame pair with landmarks and means (as the paper's Figs 3 and 5 to
// 7), and the histogram of their midpoints with its valley (Fig. 4).
#ifndef CLIENT_PICTURE_FLOW_PICTURE_H_
#define CLIENT_PICTURE_FLOW_PICTURE_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/picture/canvas.h"
#include "homing/flow/flow_vector.h"
#include "homing/landmark/landmark_finder.h"
#include "homing/landmark/landmark_options.h"
#include "homing/similarity/deviation_model.h"

namespace homing::client {

// One camera at one instant.
struct FlowPanel {
  std::string title;
  FlowField field;
  // The later frame, drawn faintly behind; empty: none.
  GrayImage image;
  // The same place at another time, drawn in green and compared (Figs 5 to 7).
  std::optional<FlowField> reference;
};

struct FlowPictureOptions {
  LandmarkOptions landmark;
  DeviationModel model;
  // Also the histogram of the midpoints (Fig. 4).
  bool histogram = false;
};

// Draws the panels side by side. Errors of Canvas.
absl::Status DrawFlow(const std::string& path, const std::vector<FlowPanel>& panels,
                      const FlowPictureOptions& options);

}  // namespace homing::client

#endif  // CLIENT_PICTURE_FLOW_PICTURE_H_
