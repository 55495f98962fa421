#include "proto/wire/observation_conversion.h"

#include <cmath>
#include <cstdint>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/limit_error.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "proto/wire/enum_conversion.h"

namespace homing::wire {
namespace {

using Column = google::protobuf::RepeatedField<float>;

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
// The last second whose nanoseconds fit into 64 bits.
constexpr std::int64_t kMaxSeconds = 9'223'372'035;
// Larger than any image, small enough for all arithmetic, pixels.
constexpr float kMaxCoordinate = 65536;

bool IsRaw(FrameEncoding encoding) {
  return encoding == FrameEncoding::kGray8 || encoding == FrameEncoding::kRgb8 ||
         encoding == FrameEncoding::kBgr8;
}

// A field's name in two parts: its message's, and its own.
struct FieldName {
  const std::string& holder;
  const char* own;
  std::string ToString() const { return absl::StrCat(holder, own); }
};

absl::Status CheckSide(int value, int min, int max, const FieldName& field) {
  // The name is made for an error only: this runs for every observation.
  if (value >= min && value <= max) return absl::OkStatus();
  return CheckRange(field.ToString(), value, min, max, "px");
}

absl::Status CheckColumn(const Column& column, int size, const FieldName& field) {
  if (column.size() != size) {
    return MustBe(field.ToString(), column.size(), absl::StrCat(size, " entries, as start_x"));
  }
  // Almost always all are valid: the test has no branch for each value.
  std::int32_t beyond = 0;
  for (const float value : column) {
    beyond |= std::abs(value) <= kMaxCoordinate ? 0 : 1;
  }
  for (int i = 0; beyond != 0 && i < size; ++i) {
    if (!(std::abs(column[i]) <= kMaxCoordinate)) {
      return MustBe(absl::StrCat(field.ToString(), "[", i, "]"), column[i],
                    absl::StrCat("in [-", kMaxCoordinate, ", ", kMaxCoordinate, "] px"));
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<CameraView> ViewFromProto(const v1::CameraView& message, const std::string& field,
                                         const WireLimits& limits) {
  switch (message.content_case()) {
    case v1::CameraView::kFrame: {
      HOMING_ASSIGN_OR_RETURN(Frame frame,
                              FromProto(message.frame(), absl::StrCat(field, ".frame"), limits));
      return CameraView(frame);
    }
    case v1::CameraView::kFlowVectors: {
      HOMING_ASSIGN_OR_RETURN(
          FlowField flow,
          FromProto(message.flow_vectors(), absl::StrCat(field, ".flow_vectors"), limits));
      return CameraView(std::move(flow));
    }
    case v1::CameraView::CONTENT_NOT_SET:
      break;
  }
  return CameraView();
}

void ViewToProto(const CameraView& view, v1::CameraView* message) {
  if (const auto* frame = std::get_if<Frame>(&view)) {
    *message->mutable_frame() = ToProto(*frame);
  } else if (const auto* flow = std::get_if<FlowField>(&view)) {
    *message->mutable_flow_vectors() = ToProto(*flow);
  }
}

absl::Status CheckNumber(std::int64_t number, const char* field) {
  if (number < 0) return MustBe(field, number, "at least 0");
  if (number > kMostSequence) return MustBe(field, number, absl::StrCat("at most ", kMostSequence));
  return absl::OkStatus();
}

bool IsEmpty(const CameraView& view) { return std::holds_alternative<std::monostate>(view); }

}  // namespace

absl::StatusOr<Frame> FromProto(const v1::Frame& message, const std::string& field,
                                const WireLimits& limits) {
  Frame frame;
  HOMING_ASSIGN_OR_RETURN(frame.encoding,
                          FromProto(message.encoding(), absl::StrCat(field, ".encoding")));
  const int min = IsRaw(frame.encoding) ? 1 : 0;
  HOMING_RETURN_IF_ERROR(CheckSide(message.width(), min, limits.max_side_px, {field, ".width"}));
  HOMING_RETURN_IF_ERROR(CheckSide(message.height(), min, limits.max_side_px, {field, ".height"}));
  if (message.data().empty()) {
    return FieldError(absl::StrCat(field, ".data"), "must hold the image's bytes");
  }
  frame.width = message.width();
  frame.height = message.height();
  frame.data = message.data();
  return frame;
}

absl::StatusOr<FlowField> FromProto(const v1::FlowVectors& message, const std::string& field,
                                    const WireLimits& limits) {
  HOMING_RETURN_IF_ERROR(CheckSide(message.width(), 1, limits.max_side_px, {field, ".width"}));
  HOMING_RETURN_IF_ERROR(CheckSide(message.height(), 1, limits.max_side_px, {field, ".height"}));
  const int size = message.start_x_size();
  if (size > limits.max_vectors) {
    return LimitError("VECTORS", absl::StrCat(field, ".start_x"), size,
                      absl::StrCat("at most ", limits.max_vectors, " entries"));
  }
  HOMING_RETURN_IF_ERROR(CheckColumn(message.start_x(), size, {field, ".start_x"}));
  HOMING_RETURN_IF_ERROR(CheckColumn(message.start_y(), size, {field, ".start_y"}));
  HOMING_RETURN_IF_ERROR(CheckColumn(message.end_x(), size, {field, ".end_x"}));
  HOMING_RETURN_IF_ERROR(CheckColumn(message.end_y(), size, {field, ".end_y"}));
  FlowField flow;
  flow.width = message.width();
  flow.height = message.height();
  flow.vectors.reserve(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    flow.vectors.push_back(
        {message.start_x(i), message.start_y(i), message.end_x(i), message.end_y(i)});
  }
  return flow;
}

absl::StatusOr<Observation> FromProto(const v1::Observation& message, const WireLimits& limits) {
  Observation observation;
  HOMING_RETURN_IF_ERROR(CheckNumber(message.sequence(), "observation.sequence"));
  observation.sequence = message.sequence();
  HOMING_ASSIGN_OR_RETURN(observation.capture_time_ns,
                          FromProto(message.capture_time(), "observation.capture_time"));
  observation.break_before = message.break_before();
  if (message.has_frame()) {
    HOMING_RETURN_IF_ERROR(CheckNumber(message.frame(), "observation.frame"));
    observation.frame = message.frame();
  }
  HOMING_ASSIGN_OR_RETURN(observation.views[0],
                          ViewFromProto(message.left(), "observation.left", limits));
  HOMING_ASSIGN_OR_RETURN(observation.views[1],
                          ViewFromProto(message.right(), "observation.right", limits));
  if (IsEmpty(observation.views[0]) && IsEmpty(observation.views[1])) {
    return FieldError("observation.left", "must be set unless observation.right is");
  }
  return observation;
}

absl::StatusOr<std::int64_t> FromProto(const google::protobuf::Timestamp& message,
                                       const std::string& field) {
  if (message.seconds() < 0 || message.seconds() > kMaxSeconds) {
    return CheckRange<std::int64_t>(absl::StrCat(field, ".seconds"), message.seconds(), 0,
                                    kMaxSeconds, "s");
  }
  if (message.nanos() < 0 || message.nanos() >= kNanosecondsPerSecond) {
    return CheckRange<std::int64_t>(absl::StrCat(field, ".nanos"), message.nanos(), 0,
                                    kNanosecondsPerSecond - 1, "ns");
  }
  return message.seconds() * kNanosecondsPerSecond + message.nanos();
}

v1::Frame ToProto(const Frame& frame) {
  v1::Frame message;
  message.set_encoding(ToProto(frame.encoding));
  message.set_width(frame.width);
  message.set_height(frame.height);
  message.set_data(frame.data.data(), frame.data.size());
  return message;
}

v1::FlowVectors ToProto(const FlowField& flow) {
  v1::FlowVectors message;
  message.set_width(flow.width);
  message.set_height(flow.height);
  const int size = static_cast<int>(flow.vectors.size());
  message.mutable_start_x()->Reserve(size);
  message.mutable_start_y()->Reserve(size);
  message.mutable_end_x()->Reserve(size);
  message.mutable_end_y()->Reserve(size);
  for (const FlowVector& vector : flow.vectors) {
    message.add_start_x(vector.start_x);
    message.add_start_y(vector.start_y);
    message.add_end_x(vector.end_x);
    message.add_end_y(vector.end_y);
  }
  return message;
}

v1::Observation ToProto(const Observation& observation) {
  v1::Observation message;
  message.set_sequence(observation.sequence);
  if (observation.capture_time_ns != 0) {
    *message.mutable_capture_time() = TimestampToProto(observation.capture_time_ns);
  }
  if (!IsEmpty(observation.views[0])) ViewToProto(observation.views[0], message.mutable_left());
  if (!IsEmpty(observation.views[1])) ViewToProto(observation.views[1], message.mutable_right());
  message.set_break_before(observation.break_before);
  if (observation.frame) message.set_frame(*observation.frame);
  return message;
}

google::protobuf::Timestamp TimestampToProto(std::int64_t time_ns) {
  google::protobuf::Timestamp message;
  message.set_seconds(time_ns / kNanosecondsPerSecond);
  message.set_nanos(static_cast<std::int32_t>(time_ns % kNanosecondsPerSecond));
  return message;
}

}  // namespace homing::wire
