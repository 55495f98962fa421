// Sources of a robot's frames: image folders, video files, cameras, the simulator.
#ifndef CLIENT_SOURCE_FRAME_SOURCE_H_
#define CLIENT_SOURCE_FRAME_SOURCE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/flow/camera.h"
#include "homing/flow/observation.h"
#include "homing/image/frame.h"

namespace homing::client {

// One image; owns its bytes. JPEG and PNG files are passed on unchanged.
struct SourceFrame {
  FrameEncoding encoding = FrameEncoding::kGray8;
  int width = 0;
  int height = 0;
  std::string data;
  // Nanoseconds; 0: unknown.
  std::int64_t capture_time_ns = 0;
  // Frames before this one are missing: no flow spans the gap.
  bool gap_before = false;
  // Names the file and its fault; empty: the frame can be used.
  std::string fault = "";

  Frame view() const { return {encoding, width, height, data}; }
};

// Keys by which the frames of a source are paired with those of another camera.
struct FrameKeys {
  // kTime: nanoseconds from any instant on; kNumber: a counter; kOrder: nothing but their order.
  enum class Kind { kOrder, kNumber, kTime };
  Kind kind = Kind::kOrder;
  // One a frame, ascending; empty for kOrder.
  std::vector<std::int64_t> values;
};

// Frames of one camera in order. Not thread-safe.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // std::nullopt at the end. A frame with a fault counts; the next call continues behind it.
  virtual absl::StatusOr<std::optional<SourceFrame>> Next() = 0;
  // Number of frames, -1 if not known (live camera).
  virtual std::int64_t size() const { return -1; }
  // The same as size(), or the number in a video's header, which need not be true.
  virtual std::int64_t promised_size() const { return size(); }
  // Seeks to frame `index` (at most size(); beyond the end of a video: its end); false: not
  // possible (live camera).
  virtual bool Seek(std::int64_t index) = 0;
  // A camera or a pipe: it has no end, and frames cannot be read again.
  virtual bool live() const { return false; }
  virtual FrameKeys keys() const { return {}; }
  // Frames a second, 0 if not known.
  virtual double fps() const { return 0; }
  // A message on omitted files for the user; empty: none.
  virtual std::string remark() const { return ""; }
  // Names the source of the frames, if two cameras must not share it; else empty.
  virtual std::string name() const { return ""; }
  // The camera as the source itself describes it; std::nullopt if it does not.
  virtual std::optional<Camera> camera() const { return std::nullopt; }
};

// True for the address of a camera: rtsp:// or http://, also encrypted.
bool IsNetworkSource(const std::string& source);

// Checks that the text names a source, without opening it. INVALID_ARGUMENT.
absl::Status CheckSourceText(const std::string& source);

// SOURCE of the command line, for one camera (a simulated scene has two):
// folder or glob, video file, /dev/videoN, bag (client/bag/bag_source.h) or a folder with one,
// "sim:SCENE[,key=value...]". INVALID_ARGUMENT (malformed, unknown scene or key), NOT_FOUND (no
// images).
absl::StatusOr<std::unique_ptr<FrameSource>> OpenFrameSource(const std::string& source,
                                                             Side camera);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_FRAME_SOURCE_H_
