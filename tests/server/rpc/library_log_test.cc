#include "server/rpc/library_log.h"

#include <grpc/support/log.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <sstream>

namespace homing::server {
namespace {

TEST(LibraryLogTest, BrokenRequestsFillNoLog) {
  std::ostringstream text;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text)));
  LimitLogOfLibraries();
  gpr_set_log_verbosity(GPR_LOG_SEVERITY_ERROR);
  for (int i = 0; i < 1000; ++i) gpr_log(GPR_ERROR, "broken request %d", i);
  spdlog::set_default_logger(before);
  const std::string lines = text.str();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 10);
}

}  // namespace
}  // namespace homing::server
