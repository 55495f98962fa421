#include "proto/wire/message_parts.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

#include <cstdint>
#include <limits>

namespace homing::wire {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::uint32_t kMaxBytes = std::numeric_limits<std::int32_t>::max();

bool IsOfWireType(const FieldDescriptor& field, WireFormatLite::WireType type) {
  const auto wanted =
      WireFormatLite::WireTypeForFieldType(static_cast<WireFormatLite::FieldType>(field.type()));
  return type == wanted ||
         (field.is_packable() && type == WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
}

// Up to the input's limit. False: there are more than `left`, or the bytes are no message. Groups
// are refused, since the API has none.
bool Count(const Descriptor& type, CodedInputStream* input, int* left) {
  while (const std::uint32_t tag = input->ReadTag()) {
    const auto wire_type = WireFormatLite::GetTagWireType(tag);
    const FieldDescriptor* field = type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
    // Protobuf keeps a field of another wire type as an unknown one.
    if (field != nullptr && !IsOfWireType(*field, wire_type)) field = nullptr;
    const bool is_message = field != nullptr && field->message_type() != nullptr;
    const bool is_text = field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_STRING;
    if (field == nullptr || is_message || (is_text && field->is_repeated())) {
      if (--*left < 0) return false;
    }
    if (wire_type == WireFormatLite::WIRETYPE_START_GROUP) return false;
    if (!is_message) {
      if (!WireFormatLite::SkipField(input, tag)) return false;
      continue;
    }
    std::uint32_t size = 0;
    if (!input->ReadVarint32(&size) || size > kMaxBytes) return false;
    const CodedInputStream::Limit outer = input->PushLimit(static_cast<int>(size));
    if (!Count(*field->message_type(), input, left)) return false;
    input->PopLimit(outer);
  }
  return input->ConsumedEntireMessage();
}

}  // namespace

std::optional<int> CountParts(const Descriptor& type,
                              google::protobuf::io::ZeroCopyInputStream* bytes, int most) {
  CodedInputStream input(bytes);
  int left = most;
  const bool counted = Count(type, &input, &left);
  return counted || left < 0 ? std::optional(most - left) : std::nullopt;
}

}  // namespace homing::wire
