// Draws a robot's way home beside the outbound one: from above, and as curves of offset and heading
// over the distance. Each curve shows the true values and those of the answers.
#ifndef CLIENT_PICTURE_DRIVE_PICTURE_H_
#define CLIENT_PICTURE_DRIVE_PICTURE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/picture/canvas.h"

namespace homing::client {

struct DrivePicture {
  enum class Outcome { kNone, kMatch, kAmbiguous, kUnknownPlace };
  struct Driven {
    // From above, m.
    Point place;
    // Along the outbound path from home, and to the left of it, m.
    double route_m = 0;
    double left_m = 0;
    // To the robot's left, against its way along the path, degrees.
    double heading_deg = 0;
    Outcome outcome = Outcome::kNone;
  };
  std::string title;
  // From home on.
  std::vector<Point> outbound;
  std::vector<Driven> driven;
};

// As Canvas.
absl::Status DrawDrive(const std::string& path, const DrivePicture& picture);

}  // namespace homing::client

#endif  // CLIENT_PICTURE_DRIVE_PICTURE_H_
