#include "client/source/view_window.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/source/image_folder.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr int kMinSidePx = 16;
constexpr int kMaxSidePx = 8192;
constexpr double kHalf = 127.5;
// The picture fades out over this fraction of the image's width: the tracker would follow a sharp
// edge.
constexpr double kFadeFraction = 1.0 / 40;
constexpr double kFarWeight = 0.02;

class WindowSource : public FrameSource {
 public:
  WindowSource(std::unique_ptr<FrameSource> source, ViewWindow window, const cv::Mat& mask)
      : source_(std::move(source)), window_(std::move(window)) {
    if (!mask.empty()) MakeWeights(mask);
  }

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    HOMING_ASSIGN_OR_RETURN(auto frame, source_->Next());
    if (!frame || !frame->fault.empty()) return frame;
    auto gray = DecodeGray(frame->view());
    const absl::Status status = gray.ok() ? Apply(&*gray) : gray.status();
    if (status.ok()) {
      frame->encoding = FrameEncoding::kGray8;
      frame->width = gray->cols;
      frame->height = gray->rows;
      frame->data.assign(reinterpret_cast<const char*>(gray->data), gray->total());
    } else {
      frame->fault = std::string(status.message());
    }
    return frame;
  }

  std::int64_t size() const override { return source_->size(); }
  std::int64_t promised_size() const override { return source_->promised_size(); }
  bool Seek(std::int64_t index) override { return source_->Seek(index); }
  bool live() const override { return source_->live(); }
  FrameKeys keys() const override { return source_->keys(); }
  double fps() const override { return source_->fps(); }
  std::string remark() const override { return source_->remark(); }
  std::string name() const override { return source_->name(); }
  std::optional<Camera> camera() const override {
    const auto camera = source_->camera();
    return camera ? std::make_optional(CropCamera(*camera, window_)) : std::nullopt;
  }

 private:
  // Sets the weight of each pixel, 0..1: 0 where the mask is black, then a slope.
  void MakeWeights(const cv::Mat& mask) {
    const int fade = 2 * std::max(2, static_cast<int>(mask.cols * kFadeFraction)) + 1;
    cv::Mat used = mask > kHalf;
    cv::erode(used, used, cv::Mat::ones(fade, fade, CV_8U), cv::Point(-1, -1), 1,
              cv::BORDER_CONSTANT, cv::Scalar(255));
    used.convertTo(weights_, CV_32F, 1.0 / 255);
    cv::blur(weights_, weights_, cv::Size(fade, fade), cv::Point(-1, -1), cv::BORDER_REPLICATE);
    // A white part that is thinner than the fade would vanish.
    if (cv::countNonZero(weights_) == 0)
      cv::Mat(mask > kHalf).convertTo(weights_, CV_32F, 1.0 / 255);
    Smooth(weights_, &nearby_);
    nearby_ += kFarWeight;
  }

  absl::Status Apply(cv::Mat* image) const {
    if (!weights_.empty()) {
      if (image->size() != weights_.size()) {
        return absl::InvalidArgumentError(
            absl::StrCat("the frame is ", image->cols, " x ", image->rows, ", the mask ",
                         window_.mask, " is ", weights_.cols, " x ", weights_.rows));
      }
      Fade(image);
    }
    if (!window_.crop) return absl::OkStatus();
    const CropRectangle& crop = *window_.crop;
    if (crop.x + crop.width > image->cols || crop.y + crop.height > image->rows) {
      return absl::InvalidArgumentError(
          absl::StrCat("the frame is ", image->cols, " x ", image->rows, ", the crop ends at ",
                       crop.x + crop.width, ", ", crop.y + crop.height));
    }
    *image = (*image)(cv::Rect(crop.x, crop.y, crop.width, crop.height)).clone();
    return absl::OkStatus();
  }

  void Fade(cv::Mat* image) const {
    cv::Mat values;
    image->convertTo(values, CV_32F);
    // The mean of the used pixels nearby; far from them, the mean of all used pixels.
    const double whole = cv::sum(values.mul(weights_))[0] / cv::sum(weights_)[0];
    cv::Mat level;
    Smooth(values.mul(weights_), &level);
    level = (level + kFarWeight * whole) / nearby_;
    values = (values - level).mul(weights_) + level;
    values.convertTo(*image, CV_8U);
  }

  void Smooth(const cv::Mat& from, cv::Mat* to) const {
    const int side = 2 * std::max(2, from.cols / 10) + 1;
    cv::blur(from, *to, cv::Size(side, side), cv::Point(-1, -1), cv::BORDER_REPLICATE);
    cv::blur(*to, *to, cv::Size(side, side), cv::Point(-1, -1), cv::BORDER_REPLICATE);
  }

  std::unique_ptr<FrameSource> source_;
  ViewWindow window_;
  cv::Mat weights_;
  // Sum of the weights near each pixel, plus kFarWeight.
  cv::Mat nearby_;
};

absl::StatusOr<cv::Mat> ReadMask(const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(const SourceFrame image, ReadImage(path));
  auto mask = DecodeGray(image.view());
  if (!mask.ok()) return Within(path, mask.status());
  const cv::Mat used = *mask > kHalf;
  if (cv::countNonZero(used) == 0) {
    return absl::InvalidArgumentError(absl::StrCat(path, " is black: no pixel would be used"));
  }
  return *std::move(mask);
}

}  // namespace

absl::StatusOr<CropRectangle> ParseCrop(const std::string& text) {
  const std::vector<std::string> parts = absl::StrSplit(text, ',');
  std::array<int, 4> values{};
  bool good = parts.size() == values.size();
  for (std::size_t i = 0; good && i < values.size(); ++i) {
    good = absl::SimpleAtoi(parts[i], &values[i]) && values[i] >= (i < 2 ? 0 : kMinSidePx) &&
           values[i] <= kMaxSidePx;
  }
  if (good) return CropRectangle{values[0], values[1], values[2], values[3]};
  return absl::InvalidArgumentError(absl::StrCat("crop is \"", text,
                                                 "\"; it must be X,Y,WIDTH,HEIGHT in pixels, sides "
                                                 "from ",
                                                 kMinSidePx, " to ", kMaxSidePx));
}

Camera CropCamera(Camera camera, const ViewWindow& window) {
  if (!window.crop) return camera;
  camera.width = window.crop->width;
  camera.height = window.crop->height;
  if (camera.intrinsics) {
    camera.intrinsics->center_x -= window.crop->x;
    camera.intrinsics->center_y -= window.crop->y;
  }
  return camera;
}

absl::StatusOr<std::unique_ptr<FrameSource>> OpenWindow(std::unique_ptr<FrameSource> source,
                                                        const ViewWindow& window) {
  if (window.whole()) return source;
  cv::Mat mask;
  if (!window.mask.empty()) {
    HOMING_ASSIGN_OR_RETURN(mask, ReadMask(window.mask));
  }
  return std::make_unique<WindowSource>(std::move(source), window, mask);
}

}  // namespace homing::client
