// Draws the way home: the believed and the true place, and the confidence of the answer.
#ifndef CLIENT_PICTURE_POSITION_PICTURE_H_
#define CLIENT_PICTURE_POSITION_PICTURE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace homing::client {

struct BelievedPlace {
  std::int64_t sequence = 0;
  // Along the route from home; metres, or steps if no truth is known. Absent: lost.
  std::optional<double> believed;
  std::optional<double> truth;
  // Of the interval, 0..1.
  double probability = 0;
  bool is_match = false;
};

struct PositionPicture {
  std::string title;
  // "metres" or "steps".
  std::string unit = "metres";
  std::vector<BelievedPlace> places;
};

// Errors of Canvas.
absl::Status DrawPositions(const std::string& path, const PositionPicture& picture);

}  // namespace homing::client

#endif  // CLIENT_PICTURE_POSITION_PICTURE_H_
