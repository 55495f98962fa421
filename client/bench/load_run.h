// A load on a server: many robots, each on its own connection, at a steady rate.
#ifndef CLIENT_BENCH_LOAD_RUN_H_
#define CLIENT_BENCH_LOAD_RUN_H_

#include <functional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/bench/load_robot.h"
#include "client/connection.h"

namespace homing::client {

struct LoadOptions {
  // [1, 100'000].
  int robots = 100;
  // Observations a second of each robot. (0, 1000].
  double rate = 10;
  double seconds = 10;
  // Robots start one after the other over this time, s, and send for `seconds` each. [0, 1e6].
  double ramp_seconds = 0;
  // Frames instead of flow vectors.
  bool frames = false;
  // Vectors of each observation. [0, 100'000].
  int vectors = 200;
  // Localise instead of record.
  bool localize = false;
  // The number of journeys that localising robots share, and their steps; they are recorded first.
  int journeys = 10;
  int steps = 2000;
  // Time for the last answers after the last observation, s. (0, 1e6].
  double grace_seconds = 30;
  // Prefix of the robots' ids; a number follows.
  std::string prefix = "bench";
  // Record the journeys only.
  bool prepare_only = false;
};

// INVALID_ARGUMENT naming field, value and limit.
absl::Status Validate(const LoadOptions& options);

struct LoadResult {
  LoadCounts counts;
  // From the first observation's scheduled time to the last answer.
  double seconds = 0;
  // Robots whose stream ended with an error.
  int failed_robots = 0;
};

using LoadLog = std::function<void(const std::string&)>;

// Errors of single robots are in the result. CANCELLED: stopped. Errors of the calls.
absl::StatusOr<LoadResult> RunLoad(const ConnectionOptions& connection, const LoadOptions& options,
                                   const LoadLog& log, const std::stop_token& stop);

}  // namespace homing::client

#endif  // CLIENT_BENCH_LOAD_RUN_H_
