#include "server/rpc/library_log.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"

namespace homing::server {
namespace {

constexpr int kLinesAMinute = 10;

struct Budget {
  Mutex mutex;
  std::chrono::steady_clock::time_point begin;
  int lines = 0;
  std::int64_t left_out = 0;
};

// Writes the line unless there were too many of `kind`.
void Log(Budget* budget, const char* kind, spdlog::level::level_enum level,
         const std::string& text) {
  std::int64_t left_out = 0;
  {
    const MutexLock lock(budget->mutex);
    const auto now = std::chrono::steady_clock::now();
    if (now - budget->begin >= std::chrono::minutes(1)) {
      budget->begin = now;
      budget->lines = 0;
      left_out = std::exchange(budget->left_out, 0);
    }
    if (++budget->lines > kLinesAMinute) {
      ++budget->left_out;
      return;
    }
  }
  if (left_out > 0) spdlog::warn("{} earlier lines of {} were omitted", left_out, kind);
  spdlog::log(level, "{}", text);
}

void LogOfLibrary(bool error, const char* library, const char* text) {
  static Budget budget;
  Log(&budget, "libraries", error ? spdlog::level::err : spdlog::level::info,
      absl::StrCat(library, ": ", text));
}

void LogOfGrpc(gpr_log_func_args* line) {
  LogOfLibrary(line->severity == GPR_LOG_SEVERITY_ERROR, "gRPC", line->message);
}

void LogOfProtobuf(google::protobuf::LogLevel level, const char* /*file*/, int /*line*/,
                   const std::string& message) {
  LogOfLibrary(level >= google::protobuf::LOGLEVEL_ERROR, "Protobuf", message.c_str());
}

}  // namespace

void LogOfStranger(const std::string& text) {
  static Budget budget;
  Log(&budget, "callers without an identity", spdlog::level::info, text);
}

void LimitLogOfLibraries() {
  gpr_set_log_function(&LogOfGrpc);
  google::protobuf::SetLogHandler(&LogOfProtobuf);
}

}  // namespace homing::server
