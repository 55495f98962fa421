// A robot's one or two cameras to numbered observations: the frames themselves, or the flow
// computed here with the journey's settings. Source: own design; flow: paper II-B.
#ifndef CLIENT_CAMERA_OBSERVATIONS_H_
#define CLIENT_CAMERA_OBSERVATIONS_H_

#include <array>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "client/frame_source.h"
#include "client/observation_stream.h"
#include "homing/flow/observation.h"

namespace homing::client {

// Indexed by Side: the robot's cameras.
using Cameras = std::array<std::unique_ptr<FrameSource>, 2>;

// Opens those that are named; at least one. As OpenFrameSource.
absl::StatusOr<Cameras> OpenCameras(const std::string& left, const std::string& right);

class CameraObservations : public ObservationStream {
 public:
  // With `flow` set, flow vectors, of the frames that make a step: the flow since the frame that
  // made the step before. REQUIRES: a camera; Validate(*flow).ok().
  CameraObservations(Cameras cameras, const std::optional<FlowOptions>& flow);

  absl::StatusOr<std::optional<v1::Observation>> Next() override;
  void set_last_frame(std::int64_t frame) override { last_frame_ = frame; }
  bool Seek(std::int64_t sequence) override;
  void ContinueAt(std::int64_t sequence) override;

  // Next is CANCELLED once this is requested, also while nothing moves and no flow is made.
  void StopAt(std::stop_token stop) { stop_ = std::move(stop); }

  // Number of frames of the longer camera, -1 if not known.
  std::int64_t size() const;

 private:
  // Frames of one instant; own the bytes that an Observation views.
  using Instant = std::array<std::optional<SourceFrame>, 2>;

  absl::StatusOr<std::optional<Instant>> NextInstant();
  absl::StatusOr<std::optional<Observation>> NextFlow();
  v1::Observation Number(Observation observation);
  void ForgetReference();
  bool SeekCameras(std::int64_t frame);
  bool SeekFlow(std::int64_t sequence);

  Cameras cameras_;
  std::optional<FlowOptions> flow_options_;
  std::optional<ObservationFlow> flow_;
  std::int64_t next_ = 0;
  // Index of the next frame in the source.
  std::int64_t next_frame_ = 0;
  std::int64_t last_frame_ = -1;
  std::stop_token stop_;
  bool break_ = false;
};

}  // namespace homing::client

#endif  // CLIENT_CAMERA_OBSERVATIONS_H_
