// How much the server takes, of everyone and of one robot.
#ifndef SERVER_ADMISSION_LIMITS_H_
#define SERVER_ADMISSION_LIMITS_H_

#include <cstdint>

namespace homing::server {

// 0 is "no limit" wherever it is allowed. Limits of one robot go by the identity of the caller, or,
// when nobody is asked who they are, by the robot that the journey's name names.
struct Limits {
  // Open streams (recording, localising, export, import), in all and of one robot. [0, 1'000'000].
  int max_streams = 4096;
  int max_robot_streams = 0;
  // Observations of one robot a second, over all its streams; twice as many at once.
  // [0, 1'000'000].
  int max_robot_rate = 0;
  // Journeys kept of one robot. [0, 1'000'000'000].
  std::int64_t max_robot_journeys = 0;
  // Bytes kept of one robot: 16 a fingerprint and 216 a step (two flow profiles at their largest).
  std::int64_t max_robot_bytes = 0;
  // Most that the database may grow to, bytes.
  std::int64_t max_database = 0;
  // A stream on which nothing moves for this long is closed, s. [0, 86'400].
  int idle_stream_s = 900;
  // A connection that is silent for this long is asked whether it is still there, s; it must answer
  // within half of that. [1, 3600].
  int keepalive_s = 20;
  // Memory that gRPC may take for messages under way, bytes. 0, [16 MiB, 1 TiB].
  std::int64_t memory_quota = std::int64_t{1} << 30;
  // Finished journeys older than this are deleted, s after their creation by the server's clock; 0:
  // none ever is. [0, 10^10].
  std::int64_t delete_after_s = 0;
  // At a robot's quota its oldest finished journeys are deleted, instead of refusing new ones.
  bool delete_oldest = false;
};

}  // namespace homing::server

#endif  // SERVER_ADMISSION_LIMITS_H_
