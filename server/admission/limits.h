// Limits on the server's load, in total and for one robot.
#ifndef SERVER_ADMISSION_LIMITS_H_
#define SERVER_ADMISSION_LIMITS_H_

#include <cstdint>

namespace homing::server {

// 0 means no limit where it is allowed. The ranges are in server/config/option_table.cc. A robot is
// the caller's identity, or, without credentials, the robot in the journey's name.
struct Limits {
  // Open streams (recording, localising, export, import), in total and of one robot.
  int max_streams = 4096;
  int max_robot_streams = 0;
  // Observations of one robot a second, over all its streams. Bursts may have twice as many.
  int max_robot_rate = 0;
  // Journeys stored for one robot.
  std::int64_t max_robot_journeys = 0;
  // Bytes stored for one robot: 16 a fingerprint and 256 a step (two flow profiles).
  std::int64_t max_robot_bytes = 0;
  // Largest size of the database, bytes.
  std::int64_t max_database = 0;
  // A stream without traffic for this long is closed, s.
  int idle_stream_s = 900;
  // A connection without traffic for this long is probed, s. It must answer within half of that.
  int keepalive_s = 20;
  // Memory of gRPC for messages in transit, bytes.
  std::int64_t memory_quota = std::int64_t{1} << 30;
  // Finished journeys are deleted this long after their creation by the server's clock, s; 0:
  // never.
  std::int64_t delete_after_s = 0;
  // At a robot's quota, delete its oldest finished journeys instead of refusing new ones.
  bool delete_oldest = false;
};

}  // namespace homing::server

#endif  // SERVER_ADMISSION_LIMITS_H_
