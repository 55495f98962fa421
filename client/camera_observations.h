// Makes numbered observations from a robot's one or two cameras: the frames, or the flow computed
// here with the journey's settings. Flow: paper II-B.
#ifndef CLIENT_CAMERA_OBSERVATIONS_H_
#define CLIENT_CAMERA_OBSERVATIONS_H_

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "client/frame_source.h"
#include "client/observation_stream.h"
#include "homing/flow/observation.h"

namespace homing::client {

// Indexed by Side: the robot's cameras.
using Cameras = std::array<std::unique_ptr<FrameSource>, 2>;

// Opens the named sources; at least one. Errors of OpenFrameSource.
absl::StatusOr<Cameras> OpenCameras(const std::string& left, const std::string& right);

class CameraObservations : public ObservationStream {
 public:
  // With `flow` set, observations hold flow vectors: observation n is the flow from frame n to
  // frame n + 1, so there is one observation less. REQUIRES: a camera; Validate(*flow).ok().
  CameraObservations(Cameras cameras, const std::optional<FlowOptions>& flow);

  absl::StatusOr<std::optional<v1::Observation>> Next() override;
  bool Seek(std::int64_t sequence) override;
  void ContinueAt(std::int64_t sequence) override;

  // Number of observations, -1 if not known.
  std::int64_t size() const;

 private:
  // The frames of one instant; they own the bytes that an Observation points to.
  using Instant = std::array<std::optional<SourceFrame>, 2>;

  absl::StatusOr<std::optional<Instant>> NextInstant();
  absl::StatusOr<std::optional<Observation>> NextFlow();
  v1::Observation Number(Observation observation);
  void ForgetLastFrame();

  Cameras cameras_;
  std::optional<FlowOptions> flow_options_;
  std::optional<ObservationFlow> flow_;
  std::int64_t next_ = 0;
  bool break_ = false;
};

}  // namespace homing::client

#endif  // CLIENT_CAMERA_OBSERVATIONS_H_
