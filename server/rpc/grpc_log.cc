#include "server/rpc/grpc_log.h"

#include <grpc/support/log.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>

namespace homing::server {
namespace {

constexpr int kLinesAMinute = 10;

struct Budget {
  std::mutex mutex;
  std::chrono::steady_clock::time_point begin;
  int lines = 0;
  std::int64_t left_out = 0;
};

Budget& TheBudget() {
  static Budget budget;
  return budget;
}

void Log(gpr_log_func_args* line) {
  std::int64_t left_out = 0;
  {
    Budget& budget = TheBudget();
    const std::lock_guard lock(budget.mutex);
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
  if (left_out > 0) spdlog::warn("gRPC: {} lines were left out before this one", left_out);
  const auto level =
      line->severity == GPR_LOG_SEVERITY_ERROR ? spdlog::level::err : spdlog::level::info;
  spdlog::log(level, "gRPC: {}", line->message);
}

}  // namespace

void LimitLogOfGrpc() { gpr_set_log_function(&Log); }

}  // namespace homing::server
