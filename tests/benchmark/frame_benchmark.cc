// Frames to fingerprints against the bare OpenCV calls that the method needs: the same scaling and
// smoothing, as many corners, pyramids, Lucas-Kanade forth and back, the same windows and ends.
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <string>

#include "homing/flow/flow_tracker.h"
#include "homing/flow/working_image.h"
#include "homing/journey/journey_recorder.h"
#include "tests/benchmark/benchmarks.h"
#include "tests/benchmark/textured_drive.h"

namespace homing::benchmarks {
namespace {

constexpr int kFrames = 60;

// The loop that anyone would write.
class BareLoop {
 public:
  explicit BareLoop(int corners) : corners_(corners) {}

  std::size_t Step(const cv::Mat& gray) {
    const cv::Mat now = Smooth(gray);
    std::size_t kept = 0;
    if (!before_.empty()) {
      kept = Track(now);
    }
    before_ = now;
    return kept;
  }

 private:
  cv::Mat Smooth(const cv::Mat& gray) const {
    const cv::Size size = WorkingSize(gray.size(), options_);
    cv::Mat image;
    gray.convertTo(image, CV_32F);
    if (size != gray.size()) {
      cv::Mat resized;
      cv::resize(image, resized, size, 0, 0,
                 size.width < gray.cols ? cv::INTER_AREA : cv::INTER_LINEAR);
      image = resized;
    }
    const double sigma = options_.smoothing_sigma_px;
    cv::GaussianBlur(image, image, cv::Size(), sigma, sigma, cv::BORDER_REFLECT_101);
    cv::Mat levels;
    image.convertTo(levels, CV_8U);
    return levels;
  }

  std::size_t Track(const cv::Mat& now) const {
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(before_, corners, corners_, 0.001, options_.cell_px, {}, 5);
    std::vector<cv::Point2f> there;
    std::vector<cv::Point2f> back;
    std::vector<unsigned char> found;
    std::vector<unsigned char> found_back;
    std::vector<float> error;
    const cv::Size window(options_.window_px, options_.window_px);
    const cv::TermCriteria end(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.01);
    cv::calcOpticalFlowPyrLK(before_, now, corners, there, found, error, window,
                             options_.pyramid_levels, end);
    cv::calcOpticalFlowPyrLK(now, before_, there, back, found_back, error, window,
                             options_.pyramid_levels, end);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const cv::Point2f miss = back[i] - corners[i];
      kept += found[i] != 0 && found_back[i] != 0 && miss.dot(miss) < 0.5F ? 1 : 0;
    }
    return kept;
  }

  const FlowOptions options_;
  const int corners_;
  cv::Mat before_;
};

// As many as the method finds.
int CornersOf(const std::vector<cv::Mat>& frames) {
  FlowTracker tracker{FlowOptions()};
  std::size_t vectors = 0;
  for (const cv::Mat& frame : frames) {
    const auto field = tracker.Track(frame);
    tracker.Advance();
    vectors += field.ok() && *field ? (*field)->vectors.size() : 0;
  }
  return static_cast<int>(vectors / (frames.size() - 1));
}

void Fingerprints(benchmark::State& state, cv::Size size) {
  cv::setNumThreads(0);
  const std::vector<cv::Mat> frames = DrawFrames(size, kFrames);
  JourneyRecorder recorder{JourneySettings()};
  std::int64_t sequence = 0;
  for (auto _ : state) {
    const auto& frame = frames[static_cast<std::size_t>(sequence % kFrames)];
    const auto step = recorder.Record(FrameObservation(sequence++, frame));
    if (!step.ok()) state.SkipWithError("no step");
    benchmark::DoNotOptimize(step);
  }
}

void BareOpenCv(benchmark::State& state, cv::Size size) {
  cv::setNumThreads(0);
  const std::vector<cv::Mat> frames = DrawFrames(size, kFrames);
  BareLoop loop(CornersOf(frames));
  std::size_t next = 0;
  std::size_t kept = 0;
  for (auto _ : state) {
    kept += loop.Step(frames[next++ % kFrames]);
  }
  state.counters["vectors"] = static_cast<double>(kept) / static_cast<double>(state.iterations());
  state.counters["corners"] = CornersOf(frames);
}

}  // namespace

void RegisterFrameBenchmarks(bool /*quick*/) {
  for (const cv::Size size : {cv::Size(640, 480), cv::Size(320, 240)}) {
    const std::string name = std::to_string(size.width) + "x" + std::to_string(size.height);
    benchmark::RegisterBenchmark(("frames_" + name).c_str(), [size](benchmark::State& state) {
      Fingerprints(state, size);
    })->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("opencv_" + name).c_str(), [size](benchmark::State& state) {
      BareOpenCv(state, size);
    })->Unit(benchmark::kMillisecond);
  }
}

}  // namespace homing::benchmarks
