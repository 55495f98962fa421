#include "server/rpc/library_log.h"

#include <grpc/support/log.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <sstream>

namespace homing::server {
namespace {

std::ptrdiff_t LinesOf(const std::function<void()>& work) {
  std::ostringstream text;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text)));
  work();
  spdlog::set_default_logger(before);
  const std::string lines = text.str();
  return std::count(lines.begin(), lines.end(), '\n');
}

TEST(LibraryLogTest, BrokenRequestsFillNoLog) {
  LimitLogOfLibraries();
  gpr_set_log_verbosity(GPR_LOG_SEVERITY_ERROR);
  const auto break_requests = [] {
    for (int i = 0; i < 1000; ++i) gpr_log(GPR_ERROR, "broken request %d", i);
  };
  EXPECT_EQ(LinesOf(break_requests), 10);
}

TEST(LibraryLogTest, StrangersFillNoLog) {
  const auto call = [] {
    for (int i = 0; i < 1000; ++i) LogOfStranger("audit: -");
  };
  EXPECT_EQ(LinesOf(call), 10);
}

}  // namespace
}  // namespace homing::server
