#include "client/source/simulated_source.h"

#include <cmath>

#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

class SimulatedSource : public FrameSource {
 public:
  // `has_times`: frames have their times, which show a frame without its partner.
  SimulatedSource(std::unique_ptr<Simulator> simulator, Side camera, double fps, bool has_times)
      : simulator_(std::move(simulator)), camera_(camera), fps_(fps), has_times_(has_times) {}

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    cv::Mat image;
    while (image.empty()) {
      if (next_ >= size()) return std::optional<SourceFrame>();
      image = simulator_->RenderCamera(next_++, camera_);
    }
    SourceFrame frame{FrameEncoding::kGray8, image.cols, image.rows, {}};
    frame.data.assign(reinterpret_cast<const char*>(image.data), image.total());
    // Plus 1, because 0 means that the time is unknown.
    if (has_times_) frame.capture_time_ns = 1 + std::llround(1e9 * simulator_->TimeS(next_ - 1));
    return std::make_optional(std::move(frame));
  }
  std::int64_t size() const override { return simulator_->frame_count(); }
  double fps() const override { return fps_; }
  bool Seek(std::int64_t index) override {
    if (index < 0 || index > size()) return false;
    next_ = index;
    return true;
  }

 private:
  std::unique_ptr<Simulator> simulator_;
  Side camera_;
  double fps_;
  bool has_times_;
  std::int64_t next_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<FrameSource>> MakeSimulatedSource(const SimulationSpec& spec,
                                                                 Side camera) {
  HOMING_ASSIGN_OR_RETURN(auto simulator, Simulator::Create(spec));
  return std::make_unique<SimulatedSource>(std::move(simulator), camera, spec.fps,
                                           spec.drop_run > 0);
}

}  // namespace homing::client
