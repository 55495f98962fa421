#include "client/command/answer_bag.h"

#include <cerrno>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/command/growing_file.h"
#include "client/command/json_line.h"
#include "client/file/output_file.h"
#include "homing/base/status_macros.h"
#include "homing/landmark/landmark_finder.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

constexpr std::int64_t kUntimedStepNs = 100'000'000;
constexpr double kLandmarkDiameterPx = 16;
constexpr double kFontPx = 12;

foxglove::Color OpaqueColor(double r, double g, double b) {
  foxglove::Color color;
  color.set_r(r);
  color.set_g(g);
  color.set_b(b);
  color.set_a(1);
  return color;
}

foxglove::Point2 PixelPoint(double x, double y) {
  foxglove::Point2 point;
  point.set_x(x);
  point.set_y(y);
  return point;
}

void AddText(const std::string& text, double x, double y, const google::protobuf::Timestamp& time,
             foxglove::ImageAnnotations* annotations) {
  foxglove::TextAnnotation& line = *annotations->add_texts();
  *line.mutable_timestamp() = time;
  *line.mutable_position() = PixelPoint(x, y);
  line.set_text(text);
  line.set_font_size(kFontPx);
  *line.mutable_text_color() = OpaqueColor(1, 1, 1);
  *line.mutable_background_color() = OpaqueColor(0, 0, 0);
}

foxglove::ImageAnnotations Annotate(const FlowField& field,
                                    const google::protobuf::Timestamp& time) {
  foxglove::ImageAnnotations annotations;
  foxglove::PointsAnnotation& lines = *annotations.add_points();
  *lines.mutable_timestamp() = time;
  lines.set_type(foxglove::PointsAnnotation::LINE_LIST);
  lines.set_thickness(1);
  *lines.mutable_outline_color() = OpaqueColor(0.2, 0.9, 0.2);
  for (const FlowVector& v : field.vectors) {
    *lines.add_points() = PixelPoint(v.start_x, v.start_y);
    *lines.add_points() = PixelPoint(v.end_x, v.end_y);
  }
  for (const SeenLandmark& landmark : FindLandmarks(field, LandmarkOptions())) {
    foxglove::CircleAnnotation& circle = *annotations.add_circles();
    *circle.mutable_timestamp() = time;
    *circle.mutable_position() = PixelPoint(landmark.x, landmark.y);
    circle.set_diameter(kLandmarkDiameterPx);
    circle.set_thickness(2);
    *circle.mutable_outline_color() = OpaqueColor(1, 0.6, 0);
    AddText(absl::StrCat(landmark.count, " vectors"), landmark.x, landmark.y - kLandmarkDiameterPx,
            time, &annotations);
  }
  return annotations;
}

std::unique_ptr<google::protobuf::Message> ToImage(const v1::Frame& frame,
                                                   const google::protobuf::Timestamp& time,
                                                   const std::string& camera) {
  const bool jpeg = frame.encoding() == v1::FRAME_ENCODING_JPEG;
  if (jpeg || frame.encoding() == v1::FRAME_ENCODING_PNG) {
    auto image = std::make_unique<foxglove::CompressedImage>();
    *image->mutable_timestamp() = time;
    image->set_frame_id(camera);
    image->set_format(jpeg ? "jpeg" : "png");
    image->set_data(frame.data());
    return image;
  }
  const bool gray = frame.encoding() == v1::FRAME_ENCODING_GRAY8;
  auto image = std::make_unique<foxglove::RawImage>();
  *image->mutable_timestamp() = time;
  image->set_frame_id(camera);
  image->set_width(static_cast<std::uint32_t>(frame.width()));
  image->set_height(static_cast<std::uint32_t>(frame.height()));
  image->set_encoding(gray                                          ? "mono8"
                      : frame.encoding() == v1::FRAME_ENCODING_RGB8 ? "rgb8"
                                                                    : "bgr8");
  image->set_step(static_cast<std::uint32_t>(frame.width() * (gray ? 1 : 3)));
  image->set_data(frame.data());
  return image;
}

std::string InWords(const v1::LocalizeResponse& answer) {
  std::string text = Word(answer.outcome());
  if (answer.has_step()) absl::StrAppend(&text, ", step ", answer.step());
  absl::StrAppend(&text, absl::StrFormat(", probability %.2f", answer.probability()));
  if (answer.has_landmark() && answer.has_similarity()) {
    absl::StrAppend(
        &text, absl::StrFormat(", landmark %d P_T %.2f", answer.landmark(), answer.similarity()));
  }
  return text;
}

}  // namespace

class WatchedObservations : public ObservationStream {
 public:
  WatchedObservations(ObservationStream* inner, AnswerBag* bag) : inner_(inner), bag_(bag) {}

  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    auto next = inner_->Next();
    if (next.ok() && next->has_value()) bag_->Keep(**next);
    return next;
  }
  bool Seek(std::int64_t sequence) override {
    bag_->ForgetFlow();
    return inner_->Seek(sequence);
  }
  void ContinueAt(std::int64_t sequence) override {
    bag_->ForgetFlow();
    inner_->ContinueAt(sequence);
  }

 private:
  ObservationStream* inner_;
  AnswerBag* bag_;
};

AnswerBag::AnswerBag(std::string path, std::ofstream file, const FlowOptions& flow)
    : path_(std::move(path)),
      file_(std::move(file)),
      writer_(&file_),
      flow_options_(flow),
      flow_(flow),
      start_ns_(absl::GetCurrentTimeNanos()) {}

absl::StatusOr<std::unique_ptr<AnswerBag>> AnswerBag::Open(const std::string& path,
                                                           const FlowOptions& flow,
                                                           const std::stop_token& stop) {
  HOMING_ASSIGN_OR_RETURN(std::ofstream file, OpenGrowingFile(path, stop));
  return std::unique_ptr<AnswerBag>(new AnswerBag(path, std::move(file), flow));
}

std::unique_ptr<ObservationStream> AnswerBag::Watch(ObservationStream* inner) {
  return std::make_unique<WatchedObservations>(inner, this);
}

void AnswerBag::ForgetFlow() {
  const MutexLock lock(mutex_);
  flow_ = ObservationFlow(flow_options_);
}

// Does not keep an observation that the server will refuse; the server reports the reason.
void AnswerBag::Keep(const v1::Observation& message) {
  const MutexLock lock(mutex_);
  if (!failed_.ok()) return;
  const auto observation = wire::FromProto(message);
  if (!observation.ok()) return;
  auto flow = flow_.Compute(*observation);
  if (!flow.ok()) return;
  Seen& seen = seen_[message.sequence()];
  seen.time_ns = observation->capture_time_ns != 0
                     ? observation->capture_time_ns
                     : start_ns_ + message.sequence() * kUntimedStepNs;
  const auto time = wire::TimestampToProto(seen.time_ns);
  for (std::size_t camera = 0; camera < seen.pictures.size(); ++camera) {
    const v1::CameraView& view = camera == 0 ? message.left() : message.right();
    Picture& picture = seen.pictures[camera];
    if (view.has_frame()) picture.image = ToImage(view.frame(), time, kCameraNames[camera]);
    if (flow->fields[camera]) picture.annotations = Annotate(*flow->fields[camera], time);
  }
}

std::uint16_t AnswerBag::Channel(const std::string& topic,
                                 const google::protobuf::Message& message) {
  const auto found = channels_.find(topic);
  if (found != channels_.end()) return found->second;
  return channels_[topic] = writer_.AddChannel(topic, message.GetDescriptor());
}

absl::Status AnswerBag::WritePictures(const v1::LocalizeResponse& answer, Seen seen) {
  const auto time = wire::TimestampToProto(seen.time_ns);
  for (std::size_t camera = 0; camera < seen.pictures.size(); ++camera) {
    Picture& picture = seen.pictures[camera];
    const std::string topic = absl::StrCat("/homing/", kCameraNames[camera]);
    if (picture.image != nullptr) {
      // A camera whose frames change their kind has a topic for each.
      const bool raw = picture.image->GetDescriptor() == foxglove::RawImage::descriptor();
      HOMING_RETURN_IF_ERROR(
          writer_.Write(Channel(topic + (raw ? "/image" : "/image/compressed"), *picture.image),
                        seen.time_ns, *picture.image));
    }
    if (picture.image == nullptr && !picture.annotations) continue;
    foxglove::ImageAnnotations annotations;
    if (picture.annotations) annotations = *std::move(picture.annotations);
    AddText(InWords(answer), 4, kFontPx + 4, time, &annotations);
    HOMING_RETURN_IF_ERROR(
        writer_.Write(Channel(topic + "/annotations", annotations), seen.time_ns, annotations));
  }
  return absl::OkStatus();
}

absl::Status AnswerBag::Named(const absl::Status& status) const {
  if (status.ok()) return status;
  return CannotWrite(path_, errno == 0 ? ENOSPC : errno);
}

absl::Status AnswerBag::Add(const v1::LocalizeResponse& answer) {
  const MutexLock lock(mutex_);
  if (!failed_.ok()) return absl::OkStatus();
  errno = 0;
  failed_ = Named(Write(answer));
  if (!failed_.ok()) seen_.clear();
  return failed_;
}

absl::Status AnswerBag::Write(const v1::LocalizeResponse& answer) {
  const auto found = seen_.find(answer.sequence());
  std::int64_t time_ns = start_ns_ + answer.sequence() * kUntimedStepNs;
  if (found != seen_.end()) {
    time_ns = found->second.time_ns;
    HOMING_RETURN_IF_ERROR(WritePictures(answer, std::move(found->second)));
  }
  seen_.erase(seen_.begin(), seen_.upper_bound(answer.sequence()));
  return writer_.Write(Channel("/homing/answer", answer), time_ns, answer);
}

absl::Status AnswerBag::Finish() {
  const MutexLock lock(mutex_);
  if (!failed_.ok()) return failed_;
  errno = 0;
  return Named(writer_.Finish());
}

}  // namespace homing::client
