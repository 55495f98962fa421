// Makes numbered observations from a robot's one or two cameras: the frames, or the flow computed
// here with the journey's settings. Flow: paper II-B.
#ifndef CLIENT_CAMERA_OBSERVATIONS_H_
#define CLIENT_CAMERA_OBSERVATIONS_H_

#include <array>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "client/observation_stream.h"
#include "client/source/camera_instants.h"
#include "client/source/frame_source.h"
#include "homing/base/mutex.h"
#include "homing/flow/observation.h"

namespace homing::client {

// Opens the named sources; at least one. Errors of OpenFrameSource.
absl::StatusOr<Cameras> OpenCameras(const std::string& left, const std::string& right);

// Not thread-safe, except FrameOf.
class CameraObservations : public ObservationStream {
 public:
  // With `flow` set, observations hold flow vectors, one for each instant that makes a step: the
  // flow since the instant that made the step before. REQUIRES: Validate(*flow).ok().
  CameraObservations(std::unique_ptr<CameraInstants> instants,
                     const std::optional<FlowOptions>& flow);

  // The first instant becomes observation `sequence`: the earlier ones came from another source.
  // Call it before anything is read.
  void StartAt(std::int64_t sequence);
  // Makes Next return CANCELLED once `stop` is requested, also while no observation makes a step.
  void StopAt(std::stop_token stop) { stop_ = std::move(stop); }

  absl::StatusOr<std::optional<v1::Observation>> Next() override;
  void set_last_frame(std::int64_t frame) override { last_frame_ = frame; }
  bool Seek(std::int64_t sequence) override;
  void ContinueAt(std::int64_t sequence) override;

  // Number of instants, -1 if not known.
  std::int64_t size() const;
  // Index in the source of the frame that made an observation read already, -1: none did.
  // Thread-safe.
  std::int64_t FrameOf(std::int64_t sequence) const;

 private:
  // A point from which reading can start again.
  struct Point {
    CameraInstants::Place place;
    // Number of instants read before it.
    std::int64_t count = 0;
  };
  struct Mark {
    // Reading from here gives the observation again.
    Point from;
    // Index in the source.
    std::int64_t frame = 0;
  };

  // Also sets here_.
  absl::StatusOr<std::optional<CameraInstants::Instant>> ReadInstant();
  absl::StatusOr<std::optional<Observation>> NextFlow();
  v1::Observation Number(Observation observation);
  // Reads an observation and drops it. False: the end or an error, which Next returns again.
  bool Skip();
  std::int64_t next_mark() const;
  void AddMark(const Mark& mark);
  void Forget();
  bool GoTo(const Point& point);
  // Goes back to an observation that was read already, and drops the later marks.
  bool GoBack(std::int64_t sequence);
  void SkipToLastFrame(std::int64_t sequence);

  std::unique_ptr<CameraInstants> instants_;
  std::optional<FlowOptions> flow_options_;
  std::optional<ObservationFlow> flow_;
  // Flow only: the instant that the next flow starts from; nothing before the first one.
  std::optional<Point> reference_;
  std::int64_t base_ = 0;
  // Flow only: Observation::frame of the source's first instant.
  std::int64_t base_frame_ = 0;
  std::int64_t next_ = 0;
  // Number of instants read, and where the last one begins.
  std::int64_t count_ = 0;
  Point here_;
  std::int64_t last_frame_ = -1;
  std::stop_token stop_;
  bool break_ = false;
  mutable Mutex mutex_;
  // Sequence of the first mark.
  std::int64_t marks_from_ HOMING_GUARDED_BY(mutex_) = 0;
  // One mark for each observation that was read.
  std::vector<Mark> marks_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::client

#endif  // CLIENT_CAMERA_OBSERVATIONS_H_
