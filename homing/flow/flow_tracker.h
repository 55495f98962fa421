// Frames of one camera to flow vectors: locally normalised and smoothed image, Shi-Tomasi corners
// with an absolute threshold, pyramidal Lucas-Kanade, forward-backward check.
// Source: paper II-B, eqs 1 to 5. Normalisation, smoothing and cell-wise suppression are added.
#ifndef HOMING_FLOW_FLOW_TRACKER_H_
#define HOMING_FLOW_FLOW_TRACKER_H_

#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "absl/status/statusor.h"
#include "homing/base/cancellation.h"
#include "homing/flow/flow_vector.h"

namespace homing {

// These options change the stored fingerprints, so they are stored with the journey. Lengths are
// pixels of the working image unless named source. The defaults were measured.
struct FlowOptions {
  // Images are resized to this width before anything else (never more than doubled), so that all
  // other lengths follow the image's size. 0: not resized. 0 or
  // [16, 2048].
  int working_width_px = 320;
  // Gaussian smoothing, sigma; in SOURCE pixels where the image is enlarged, because
  // enlarging spreads the noise too. 0: none. [0, 8].
  double smoothing_sigma_px = 1.0;
  // Side of the square of local mean and deviation. [3, 255], odd.
  int normalization_window_px = 45;
  // Added to the local deviation (grey levels): walls without texture stay blank. (0, 64].
  double normalization_floor = 3.0;
  // Least minimum eigenvalue of the mean gradient matrix of the normalised image, local deviations
  // squared over px^2 (absolute, eq 3); SOURCE pixels where the image is enlarged. (0, 10].
  double min_eigenvalue = 0.02;
  // Non-maximum suppression: one best corner in a cell of this side. [1, 64].
  int cell_px = 8;
  // Lucas-Kanade window side (eq 2). [5, 63], odd.
  int window_px = 17;
  // Pyramid levels above the base. [0, 6].
  int pyramid_levels = 3;
  // A vector must come back to within this many SOURCE pixels. (0, 5].
  double max_forward_backward_px = 0.7;
  friend bool operator==(const FlowOptions&, const FlowOptions&) = default;
};

// Most corners of one frame times their window's pixels, whatever the image's size: a pair of
// frames takes a second at most. Of more corners the strongest are tracked.
inline constexpr std::size_t kMostWindowPixels = std::size_t{1} << 23;

// INVALID_ARGUMENT naming field, value and limit.
absl::Status Validate(const FlowOptions& options);

// One camera's tracker. It keeps a reference frame and the frame tracked last. Not thread-safe;
// moveable.
class FlowTracker {
 public:
  // REQUIRES: Validate(options).ok().
  explicit FlowTracker(const FlowOptions& options);
  FlowTracker(FlowTracker&&) noexcept;
  FlowTracker& operator=(FlowTracker&&) noexcept;
  ~FlowTracker();

  // `gray` is CV_8UC1. Returns the field from the reference frame to this frame, in source pixels,
  // short vectors included, in a deterministic order; nothing where there is no reference. The two
  // frames alone determine the field. INVALID_ARGUMENT: a size unlike the reference frame's.
  // CANCELLED: the frame was not tracked.
  absl::StatusOr<std::optional<FlowField>> Track(const cv::Mat& gray,
                                                 const Cancellation* cancellation = nullptr);

  // Makes the frame tracked last the reference. REQUIRES: Track was called since the last Advance.
  void Advance();

  bool has_reference() const;
  // Corners of the reference frame. REQUIRES: has_reference().
  std::size_t reference_corners() const;
  // Corners of the frame tracked last. REQUIRES: Track was called since the last Advance.
  std::size_t corners() const;

  // Forgets the reference frame: no vector spans this point.
  void Reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace homing

#endif  // HOMING_FLOW_FLOW_TRACKER_H_
