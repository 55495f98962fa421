// The header "traceparent" of W3C Trace Context: which trace a call belongs to.
#ifndef HOMING_BASE_TRACE_PARENT_H_
#define HOMING_BASE_TRACE_PARENT_H_

#include <optional>
#include <string>
#include <string_view>

namespace homing {

struct TraceParent {
  // 32 lower-case hexadecimal digits, not all 0.
  std::string trace_id;
  // 16 such digits, not all 0: the id of the caller's span.
  std::string span_id;
  // Two such digits; the last bit is set if the caller records the trace.
  std::string flags = "00";
};

inline bool IsSampled(const TraceParent& trace) {
  return std::string_view("13579bdf").find(trace.flags.back()) != std::string_view::npos;
}

inline std::string ToString(const TraceParent& trace) {
  return "00-" + trace.trace_id + "-" + trace.span_id + "-" + trace.flags;
}

// "00-TRACE-SPAN-FLAGS"; nothing: another form. A later version may append fields.
inline std::optional<TraceParent> ParseTraceParent(std::string_view text) {
  constexpr std::size_t kSize = 55;
  if (text.size() < kSize || text[2] != '-' || text[35] != '-' || text[52] != '-') return {};
  const std::string_view version = text.substr(0, 2);
  const bool longer = text.size() > kSize;
  if (longer && (version == "00" || text[kSize] != '-')) return {};
  const TraceParent trace{std::string(text.substr(3, 32)), std::string(text.substr(36, 16)),
                          std::string(text.substr(53, 2))};
  const auto is_hex = [](std::string_view digits) {
    return digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  };
  const auto is_zero = [](std::string_view digits) {
    return digits.find_first_not_of('0') == std::string_view::npos;
  };
  if (!is_hex(version) || version == "ff" || !is_hex(trace.trace_id) || !is_hex(trace.span_id) ||
      !is_hex(trace.flags) || is_zero(trace.trace_id) || is_zero(trace.span_id)) {
    return {};
  }
  return trace;
}

}  // namespace homing

#endif  // HOMING_BASE_TRACE_PARENT_H_
