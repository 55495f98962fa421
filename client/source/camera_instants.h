// One or two cameras as a row of instants: paired, thinned out, without bad frames.
#ifndef CLIENT_SOURCE_CAMERA_INSTANTS_H_
#define CLIENT_SOURCE_CAMERA_INSTANTS_H_

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/source/frame_pairing.h"
#include "client/source/frame_source.h"

namespace homing::client {

// Indexed by Side: the robot's cameras.
using Cameras = std::array<std::unique_ptr<FrameSource>, 2>;

// Which frames of the sources are used.
struct FrameChoice {
  // Every n-th instant. [1, 1000000].
  std::int64_t every = 1;
  // At most so many instants a second of the source's time; 0: all.
  double fps = 0;
  // Ends after so many seconds of the source's time; 0: at its end.
  double seconds = 0;
  // Bad frames and frames without a partner are errors; else they are skipped and reported.
  bool strict = false;
  // Receives one line of text for each thing that is left out, with the reason.
  std::function<void(const std::string&)> report = [](const std::string&) {};
  // Ends live sources.
  std::stop_token stop;
};

// Not thread-safe.
class CameraInstants {
 public:
  struct Instant {
    // They own the bytes that an Observation views.
    std::array<std::optional<SourceFrame>, 2> frames;
    // Index in the source (of two cameras: in the row of their pairs).
    std::int64_t index = 0;
    // Instants before this one are missing.
    bool gap_before = false;
  };
  // A point from which Next can continue.
  struct Place {
    std::int64_t index = 0;
    // The slot of time of the last instant; see FrameChoice::fps.
    std::int64_t slot = -1;
    bool gap = false;
  };

  // INVALID_ARGUMENT: `fps` or `seconds` for frames without times; with `strict`, frames without a
  // partner. REQUIRES: a camera.
  static absl::StatusOr<std::unique_ptr<CameraInstants>> Create(Cameras cameras,
                                                                const FrameChoice& choice);

  // The next instant; nothing at the end. INVALID_ARGUMENT: with `strict`, a bad frame; no frame is
  // usable at all. DATA_LOSS: a video ends before the number of frames that it promises.
  absl::StatusOr<std::optional<Instant>> Next();
  // The place from which the next instant will be read.
  Place place() const { return peeked_ ? peeked_from_ : place_; }
  // Goes back or forward to a place that place() gave. False: a live source.
  bool GoTo(const Place& place);
  // The next instant, which Next will give again; null at the end.
  absl::StatusOr<const Instant*> Peek();

  bool live() const;
  // Number of instants at most, -1 if not known.
  std::int64_t size() const;
  // Reports how many frames were left out, once.
  void ReportTotal();

 private:
  CameraInstants(Cameras cameras, FrameChoice choice);

  absl::Status Pair();
  // Sets holes_ and reports them.
  void TakeHoles();
  absl::Status CheckTimes() const;
  absl::StatusOr<std::optional<Instant>> Read();
  // The frames at `index`; false: all cameras are at their end.
  absl::StatusOr<bool> ReadFrames(std::int64_t index, Instant* instant);
  absl::StatusOr<std::optional<SourceFrame>> ReadFrame(std::size_t camera, std::int64_t index);
  // Drops frames with a fault. INVALID_ARGUMENT: with `strict`.
  absl::Status DropFaults(Instant* instant);
  absl::Status TakeGap(std::size_t camera, Instant* instant);
  void Report(std::size_t camera, const SourceFrame& frame);
  // Seconds since the source's first frame.
  double TimeOf(const Instant& instant);
  // True if the instant is used according to fps and seconds; sets ended_.
  bool Wanted(const Instant& instant);

  Cameras cameras_;
  FrameChoice choice_;
  std::optional<FramePairing> pairing_;
  // The cameras' keys, empty without.
  std::array<FrameKeys, 2> keys_;
  // Ascending indices of the instants before which a camera gave no frame for long.
  std::vector<std::int64_t> holes_;
  // Index of the frame that each camera gives next.
  std::array<std::int64_t, 2> position_{};
  Place place_;
  bool ended_ = false;
  std::optional<Instant> peeked_;
  Place peeked_from_;
  std::optional<std::int64_t> first_time_ns_;
  // Instants handed out, frames left out; those before furthest_ were counted already.
  std::int64_t used_ = 0;
  std::int64_t left_out_ = 0;
  std::array<std::int64_t, 2> furthest_{};
  std::string first_fault_;
};

}  // namespace homing::client

#endif  // CLIENT_SOURCE_CAMERA_INSTANTS_H_
