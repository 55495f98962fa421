// Makes numbered observations from a robot's one or two cameras: the frames, or the flow computed
// here with the journey's settings. Flow: paper II-B.
#ifndef CLIENT_CAMERA_OBSERVATIONS_H_
#define CLIENT_CAMERA_OBSERVATIONS_H_

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/camera_instants.h"
#include "client/frame_source.h"
#include "client/observation_stream.h"
#include "homing/base/mutex.h"
#include "homing/flow/observation.h"

namespace homing::client {

// Opens the named sources; at least one. Errors of OpenFrameSource.
absl::StatusOr<Cameras> OpenCameras(const std::string& left, const std::string& right);

class CameraObservations : public ObservationStream {
 public:
  // With `flow` set, observations hold flow vectors: an observation is the flow between two
  // consecutive instants, so there is at least one less. REQUIRES: Validate(*flow).ok().
  CameraObservations(std::unique_ptr<CameraInstants> instants,
                     const std::optional<FlowOptions>& flow);

  // The first instant becomes observation `sequence`: the earlier ones came from another source.
  // Call it before anything is read.
  void StartAt(std::int64_t sequence) { base_ = next_ = sequence; }

  absl::StatusOr<std::optional<v1::Observation>> Next() override;
  bool Seek(std::int64_t sequence) override;
  void ContinueAt(std::int64_t sequence) override;

  // Number of observations at most, -1 if not known.
  std::int64_t size() const;
  // Index in the source of the frame that made an observation read already, -1: none did.
  // Thread-safe.
  std::int64_t FrameOf(std::int64_t sequence) const;

 private:
  struct Mark {
    // Reading from here gives the observation again.
    CameraInstants::Place from;
    std::int64_t frame = 0;
  };

  absl::StatusOr<std::optional<Observation>> NextFlow();
  // The next instant that makes an observation, with its mark. `flow`: computed as well.
  absl::StatusOr<std::optional<CameraInstants::Instant>> NextInstant(
      std::optional<ObservedFlow>* flow);
  v1::Observation Number(Observation observation);
  std::int64_t read_count() const;
  void AddMark(const Mark& mark);
  void Forget();

  std::unique_ptr<CameraInstants> instants_;
  std::optional<FlowOptions> flow_options_;
  std::optional<ObservationFlow> flow_;
  // Flow only: the instant before, and the cameras that it has.
  CameraInstants::Place before_;
  std::array<bool, 2> had_{};
  std::int64_t base_ = 0;
  std::int64_t next_ = 0;
  bool break_ = false;
  mutable Mutex mutex_;
  // One an observation read, from base_ on.
  std::vector<Mark> marks_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::client

#endif  // CLIENT_CAMERA_OBSERVATIONS_H_
