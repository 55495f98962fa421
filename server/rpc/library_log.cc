#include "server/rpc/library_log.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

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

Budget& TheBudget() {
  static Budget budget;
  return budget;
}

void Log(spdlog::level::level_enum level, const char* library, const char* text) {
  std::int64_t left_out = 0;
  {
    Budget& budget = TheBudget();
    const MutexLock lock(budget.mutex);
    const auto now = std::chrono::steady_clock::now();
    if (now - budget.begin >= std::chrono::minutes(1)) {
      budget.begin = now;
      budget.lines = 0;
      left_out = std::exchange(budget.left_out, 0);
    }
    if (++budget.lines > kLinesAMinute) {
      ++budget.left_out;
      return;
    }
  }
  if (left_out > 0) spdlog::warn("{} earlier lines of libraries were omitted", left_out);
  spdlog::log(level, "{}: {}", library, text);
}

void LogOfGrpc(gpr_log_func_args* line) {
  const bool error = line->severity == GPR_LOG_SEVERITY_ERROR;
  Log(error ? spdlog::level::err : spdlog::level::info, "gRPC", line->message);
}

void LogOfProtobuf(google::protobuf::LogLevel level, const char* /*file*/, int /*line*/,
                   const std::string& message) {
  const bool error = level >= google::protobuf::LOGLEVEL_ERROR;
  Log(error ? spdlog::level::err : spdlog::level::info, "Protobuf", message.c_str());
}

}  // namespace

void LimitLogOfLibraries() {
  gpr_set_log_function(&LogOfGrpc);
  google::protobuf::SetLogHandler(&LogOfProtobuf);
}

}  // namespace homing::server
