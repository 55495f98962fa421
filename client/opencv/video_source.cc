#include "client/opencv/video_source.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "homing/base/status_macros.h"

namespace homing::client {

namespace {

// Excludes formats that are no videos: FFmpeg renders a text file as a video, and accepts a single
// image. The list has its names of video formats; the rest is its default.
constexpr char kFfmpegOptions[] =
    "rtsp_transport;tcp|format_whitelist;mov,mp4,m4a,3gp,3g2,mj2,avi,matroska,webm,mpegts,mpeg,"
    "mpegvideo,m4v,h261,h263,h264,hevc,av1,obu,ivf,vc1,dirac,flv,asf,ogg,mjpeg,mjpeg_2000,mpjpeg,"
    "mxf,nut,yuv4mpegpipe,dv,rm,wtv,nsv,gif,apng,rtsp,rtp,sdp,hls,dash";
// Continues the list: a camera may send JPEG images one behind the other. As a file that could be
// one image. FFmpeg recognises the format of a stream by 64 KiB, not 1 MiB, and analyses it for one
// second, not five, before the first frame.
constexpr char kLiveOptions[] = ",jpeg_pipe|formatprobesize;65536|analyzeduration;1000000";
constexpr char kNoLines[] = "-8";
// Attempts to read while frames are expected: a damaged part fails once or twice.
constexpr int kAttempts = 64;
// Time between two frames of a file from which on some are missing.
constexpr double kJumpMs = 500;
constexpr double kJumpFrames = 5;

// An address without its user name and password, because messages end up in logs.
std::string Shown(const std::string& path) {
  const std::size_t scheme = path.find("://");
  const std::size_t at = scheme == std::string::npos ? scheme : path.find('@', scheme);
  if (at == std::string::npos || path.find('/', scheme + 3) < at) return path;
  return path.substr(0, scheme + 3) + path.substr(at + 1);
}

// Grey: the method needs no more, and colour is three times as large to send.
SourceFrame ToFrame(const cv::Mat& image) {
  cv::Mat gray = image;
  if (image.channels() == 3) cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  if (!gray.isContinuous()) gray = gray.clone();
  SourceFrame frame;
  frame.encoding = FrameEncoding::kGray8;
  frame.width = gray.cols;
  frame.height = gray.rows;
  frame.data.assign(reinterpret_cast<const char*>(gray.data), gray.total());
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
      const bool device = absl::StartsWith(path_, "/dev/video");
      capture_.open(path_, device ? cv::CAP_ANY : cv::CAP_FFMPEG);
      if (!capture_.isOpened()) return NotOpened();
      if (!capture_.read(first_) || first_.empty()) {
        return absl::InvalidArgumentError(absl::StrCat(Shown(path_), " has no frames"));
      }
      // A damaged header gives any number.
      promised_ = std::llround(std::clamp(capture_.get(cv::CAP_PROP_FRAME_COUNT), 0.0, 1e12));
      fps_ = capture_.get(cv::CAP_PROP_FPS);
      last_ms_ = capture_.get(cv::CAP_PROP_POS_MSEC);
    } catch (const cv::Exception& e) {
      return absl::InvalidArgumentError(absl::StrCat(Shown(path_), ": ", e.what()));
    }
    if (first_.depth() != CV_8U || (first_.channels() != 1 && first_.channels() != 3)) {
      return absl::InvalidArgumentError(
          absl::StrCat(Shown(path_), " has frames that are not 8 bit"));
    }
    next_ = 0;
    gap_ = false;
    return absl::OkStatus();
  }

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    HOMING_ASSIGN_OR_RETURN(const cv::Mat image, Read());
    if (image.empty()) {
      HOMING_RETURN_IF_ERROR(CheckEnd());
      return std::optional<SourceFrame>();
    }
    SourceFrame frame = ToFrame(image);
    frame.gap_before = std::exchange(gap_, false);
    if (live_) frame.capture_time_ns = absl::GetCurrentTimeNanos();
    return std::make_optional(std::move(frame));
  }

  bool live() const override { return live_; }
  double fps() const override { return !live_ && std::isfinite(fps_) ? std::max(fps_, 0.0) : 0; }
  std::int64_t promised_size() const override { return live_ ? -1 : promised_; }

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
        ReadOn(&image);
      }
    } catch (const cv::Exception& e) {
      return absl::InvalidArgumentError(absl::StrCat(Shown(path_), ": ", e.what()));
    }
    if (!image.empty()) ++next_;
    return image;
  }

  absl::Status NotOpened() const {
    if (absl::StrContains(path_, "://")) {
      return absl::NotFoundError(absl::StrCat(
          Shown(path_),
          " sends no video; check the address, the name and password in it, and the camera"));
    }
    return absl::InvalidArgumentError(absl::StrCat(
        path_,
        " is not a readable video or camera; give a video file, a folder of images, or a glob of "
        "images in quotes"));
  }

  // A video continues behind a damaged part: while frames are missing, a failed read is not the
  // end.
  void ReadOn(cv::Mat* image) {
    int attempts = 0;
    while (!capture_.read(*image) && !live_ && next_ < promised_ && ++attempts < kAttempts) {
    }
    if (!image->empty()) {
      const double ms = capture_.get(cv::CAP_PROP_POS_MSEC);
      gap_ = gap_ || attempts > 0 || IsJump(ms - last_ms_);
      last_ms_ = ms;
    }
  }

  // Some formats pass over a damaged part without a failed read. Frames of uneven rate are no jump.
  bool IsJump(double ms) const {
    return !live_ && fps() > 0 && ms > kJumpMs && ms > kJumpFrames * 1000 / fps();
  }

  // If the header has no frame count, OpenCV estimates it from length and rate, which is not exact.
  absl::Status CheckEnd() const {
    if (live_) {
      std::error_code error;
      if (std::filesystem::is_fifo(path_, error)) return absl::OkStatus();
      return absl::DataLossError(absl::StrCat(Shown(path_), " sends no more frames"));
    }
    const double promised = static_cast<double>(promised_);
    const bool by_count = static_cast<double>(next_) >= 0.98 * promised - 2;
    const bool by_time = fps() > 0 && last_ms_ >= (0.98 * promised - 2) * 1000 / fps();
    if (by_count || by_time) return absl::OkStatus();
    return absl::DataLossError(absl::StrCat(Shown(path_), " is damaged: only ", next_, " of its ",
                                            promised_, " frames can be read"));
  }

  std::string path_;
  bool live_;
  cv::VideoCapture capture_;
  cv::Mat first_;
  // Number of frames by the header; 0: unknown.
  std::int64_t promised_ = 0;
  double fps_ = 0;
  double last_ms_ = 0;
  bool gap_ = false;
  std::int64_t next_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<FrameSource>> OpenVideo(const std::string& path) {
  // This module reports each fault once; OpenCV and FFmpeg stay silent. The user's own settings
  // win.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", kNoLines, /*overwrite=*/0);
  static const bool users_options = std::getenv("OPENCV_FFMPEG_CAPTURE_OPTIONS") != nullptr;
  std::error_code error;
  const bool live = !std::filesystem::is_regular_file(path, error);
  const std::string options = absl::StrCat(kFfmpegOptions, live ? kLiveOptions : "");
  if (!users_options) ::setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", options.c_str(), 1);
  auto video = std::make_unique<VideoSource>(path, live);
  HOMING_RETURN_IF_ERROR(video->Open());
  return video;
}

}  // namespace homing::client
