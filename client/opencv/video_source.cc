#include "client/opencv/video_source.h"

#include <chrono>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::client {

namespace {

std::int64_t NowNanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

SourceFrame ToFrame(const cv::Mat& image) {
  SourceFrame frame;
  frame.encoding = image.channels() == 1 ? FrameEncoding::kGray8 : FrameEncoding::kBgr8;
  frame.width = image.cols;
  frame.height = image.rows;
  const cv::Mat packed = image.isContinuous() ? image : image.clone();
  frame.data.assign(reinterpret_cast<const char*>(packed.data), packed.total() * packed.elemSize());
  return frame;
}

// Seeks by reading from the start: seeking to a key frame would give other frames than the first
// pass.
class VideoSource : public FrameSource {
 public:
  VideoSource(std::string path, bool live) : path_(std::move(path)), live_(live) {}

  // Read the first frame now, so that a file that is no video fails at once.
  absl::Status Open() {
    try {
      capture_.open(path_);
      if (!capture_.isOpened()) {
        return absl::InvalidArgumentError(absl::StrCat(path_, " is no readable video or camera"));
      }
      if (!capture_.read(first_) || first_.empty()) {
        return absl::InvalidArgumentError(absl::StrCat(path_, " has no frames"));
      }
    } catch (const cv::Exception& e) {
      return absl::InvalidArgumentError(absl::StrCat(path_, ": ", e.what()));
    }
    if (first_.depth() != CV_8U || (first_.channels() != 1 && first_.channels() != 3)) {
      return absl::InvalidArgumentError(absl::StrCat(path_, " has frames that are not 8 bit"));
    }
    next_ = 0;
    return absl::OkStatus();
  }

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    HOMING_ASSIGN_OR_RETURN(const cv::Mat image, Read());
    if (image.empty()) {
      if (live_) return absl::InvalidArgumentError(absl::StrCat(path_, " gives no more frames"));
      return std::optional<SourceFrame>();
    }
    SourceFrame frame = ToFrame(image);
    if (live_) frame.capture_time_ns = NowNanoseconds();
    return std::make_optional(std::move(frame));
  }

  bool Seek(std::int64_t index) override {
    if (live_) return false;
    if (index < next_ && !Open().ok()) return false;
    while (next_ < index) {
      const auto image = Read();
      if (!image.ok()) return false;
      if (image->empty()) break;
    }
    return true;
  }

 private:
  absl::StatusOr<cv::Mat> Read() {
    cv::Mat image;
    try {
      if (next_ == 0) {
        image = std::exchange(first_, cv::Mat());
      } else {
        capture_.read(image);
      }
    } catch (const cv::Exception& e) {
      return absl::InvalidArgumentError(absl::StrCat(path_, ": ", e.what()));
    }
    if (!image.empty()) ++next_;
    return image;
  }

  std::string path_;
  bool live_;
  cv::VideoCapture capture_;
  cv::Mat first_;
  std::int64_t next_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<FrameSource>> OpenVideo(const std::string& path) {
  // OpenCV's own messages are turned off: we report the error once.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  auto video = std::make_unique<VideoSource>(path, absl::StartsWith(path, "/dev/video"));
  HOMING_RETURN_IF_ERROR(video->Open());
  return video;
}

}  // namespace homing::client
