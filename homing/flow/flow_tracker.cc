#include "homing/flow/flow_tracker.h"

#include <algorithm>
#include <opencv2/video/tracking.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/flow/corner_detector.h"
#include "homing/flow/working_image.h"

namespace homing {

// The data kept of a frame: the pyramid of eq 1's images, with gradients, and its corners.
struct TrackedFrame {
  cv::Size source_size;
  WorkingScale scale;
  std::vector<cv::Mat> pyramid;
  std::vector<cv::Point2f> corners;
};

// Working memory, reused from frame to frame.
struct FlowBuffers {
  WorkingBuffers working;
  CornerBuffers corners;
  cv::Mat levels;
};

namespace {

// Lucas-Kanade iterations a level, and the step below which they end, working pixels.
constexpr int kIterations = 20;
constexpr double kConvergencePx = 0.01;
// Least eigenvalue of A^T A for a solution (eqs 3 to 5), OpenCV's units; corners have far more.
constexpr double kSingular = 1e-4;

// Points tracked between two checks for cancellation.
constexpr std::size_t kPointsAtATime = 256;

// Into `frame`, whose images of the same size are used again.
absl::Status Prepare(const cv::Mat& gray, const FlowOptions& options,
                     const Cancellation* cancellation, FlowBuffers* buffers, TrackedFrame* frame) {
  HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
  const cv::Mat& normalized = NormalizedImage(gray, options, &buffers->working);
  HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
  frame->source_size = gray.size();
  frame->scale = {double(normalized.cols) / gray.cols, double(normalized.rows) / gray.rows};
  frame->corners =
      DetectCorners(normalized, options, std::max(1.0, frame->scale.x), &buffers->corners);
  HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
  normalized.convertTo(buffers->levels, CV_8U, kLevelsPerDeviation, 128);
  const cv::Size window(options.window_px, options.window_px);
  cv::buildOpticalFlowPyramid(buffers->levels, frame->pyramid, window, options.pyramid_levels, true,
                              cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  return absl::OkStatus();
}

// The places of points in another frame, and whether they were found.
struct Tracks {
  std::vector<cv::Point2f> ends;
  std::vector<unsigned char> found;
};

// Each point is tracked without regard to the others.
absl::StatusOr<Tracks> TrackPoints(const TrackedFrame& from, const TrackedFrame& to,
                                   const std::vector<cv::Point2f>& points,
                                   const FlowOptions& options, const Cancellation* cancellation) {
  Tracks tracks;
  const cv::Size window(options.window_px, options.window_px);
  const cv::TermCriteria end(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations,
                             kConvergencePx);
  for (std::size_t first = 0; first < points.size(); first += kPointsAtATime) {
    HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
    const std::vector<cv::Point2f> some(
        points.begin() + static_cast<std::ptrdiff_t>(first),
        points.begin() +
            static_cast<std::ptrdiff_t>(std::min(points.size(), first + kPointsAtATime)));
    std::vector<cv::Point2f> ends;
    std::vector<unsigned char> found;
    // The tracking error is not requested: it costs as much as an iteration.
    cv::calcOpticalFlowPyrLK(from.pyramid, to.pyramid, some, ends, found, cv::noArray(), window,
                             options.pyramid_levels, end, 0, kSingular);
    tracks.ends.insert(tracks.ends.end(), ends.begin(), ends.end());
    tracks.found.insert(tracks.found.end(), found.begin(), found.end());
  }
  return tracks;
}

FlowVector SourceVector(const WorkingScale& scale, const cv::Point2f& start,
                        const cv::Point2f& end) {
  const cv::Point2d from = scale.ToSource(start);
  const cv::Point2d to = scale.ToSource(end);
  return {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(to.x),
          static_cast<float>(to.y)};
}

// True if both ends lie in the image; false if one is not finite.
bool IsInside(const FlowVector& v, const cv::Size& size) {
  const auto inside = [](float p, int side) { return p >= -0.5F && p < float(side) - 0.5F; };
  return inside(v.start_x, size.width) && inside(v.start_y, size.height) &&
         inside(v.end_x, size.width) && inside(v.end_y, size.height);
}

// Eqs 1 to 5 for the corners of `before`, forward and back again.
absl::StatusOr<FlowField> FlowBetween(const TrackedFrame& before, const TrackedFrame& now,
                                      const FlowOptions& options,
                                      const Cancellation* cancellation) {
  FlowField field{now.source_size.width, now.source_size.height, {}};
  if (before.corners.empty()) {
    return field;
  }
  HOMING_ASSIGN_OR_RETURN(const Tracks forward,
                          TrackPoints(before, now, before.corners, options, cancellation));
  HOMING_ASSIGN_OR_RETURN(const Tracks backward,
                          TrackPoints(now, before, forward.ends, options, cancellation));
  for (std::size_t i = 0; i < before.corners.size(); ++i) {
    if (forward.found[i] == 0 || backward.found[i] == 0) {
      continue;
    }
    const FlowVector miss = SourceVector(before.scale, before.corners[i], backward.ends[i]);
    const FlowVector v = SourceVector(before.scale, before.corners[i], forward.ends[i]);
    if (miss.Length() <= options.max_forward_backward_px && IsInside(v, now.source_size)) {
      field.vectors.push_back(v);
    }
  }
  return field;
}

}  // namespace

struct FlowTracker::State {
  FlowOptions options;
  FlowBuffers buffers;
  // Valid if has_reference.
  TrackedFrame reference;
  TrackedFrame now;
  bool has_reference = false;
};

FlowTracker::FlowTracker(const FlowOptions& options) : state_(std::make_unique<State>()) {
  state_->options = options;
}
FlowTracker::FlowTracker(FlowTracker&&) noexcept = default;
FlowTracker& FlowTracker::operator=(FlowTracker&&) noexcept = default;
FlowTracker::~FlowTracker() = default;

absl::StatusOr<std::optional<FlowField>> FlowTracker::Track(const cv::Mat& gray,
                                                            const Cancellation* cancellation) {
  const TrackedFrame& reference = state_->reference;
  if (gray.type() != CV_8UC1 || gray.empty()) {
    return absl::InvalidArgumentError("frame is not a grey image of 8 bits");
  }
  if (state_->has_reference && reference.source_size != gray.size()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "frame of ", gray.cols, " x ", gray.rows, " px differs from the reference frame of ",
        reference.source_size.width, " x ", reference.source_size.height, " px"));
  }
  HOMING_RETURN_IF_ERROR(
      Prepare(gray, state_->options, cancellation, &state_->buffers, &state_->now));
  if (!state_->has_reference) {
    return std::nullopt;
  }
  return FlowBetween(reference, state_->now, state_->options, cancellation);
}

void FlowTracker::Advance() {
  std::swap(state_->reference, state_->now);
  state_->has_reference = true;
}

bool FlowTracker::has_reference() const { return state_->has_reference; }

std::size_t FlowTracker::reference_corners() const { return state_->reference.corners.size(); }

std::size_t FlowTracker::corners() const { return state_->now.corners.size(); }

void FlowTracker::Reset() { state_->has_reference = false; }

}  // namespace homing
