#include "server/rpc/json_log.h"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "absl/time/time.h"
#include "server/base/trace_scope.h"

namespace homing::server {
namespace {

std::string_view View(const spdlog::string_view_t& text) { return {text.data(), text.size()}; }

class JsonFormatter final : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    nlohmann::ordered_json json = {
        {"time", absl::FormatTime("%Y-%m-%dT%H:%M:%E3SZ", absl::FromChrono(message.time),
                                  absl::UTCTimeZone())},
        {"level", View(spdlog::level::to_string_view(message.level))},
        {"message", View(message.payload)}};
    if (const TraceParent* trace = TraceScope::Current()) {
      json["trace_id"] = trace->trace_id;
      json["span_id"] = trace->span_id;
    }
    // A message may contain bytes of a client that are not UTF-8.
    const std::string text =
        json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<spdlog::formatter> clone() const override { return JsonLogFormatter(); }
};

}  // namespace

std::unique_ptr<spdlog::formatter> JsonLogFormatter() { return std::make_unique<JsonFormatter>(); }

}  // namespace homing::server
