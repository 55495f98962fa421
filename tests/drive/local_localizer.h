// The server's recorder and localizer in this process: the same code without the socket.
#ifndef TESTS_DRIVE_LOCAL_LOCALIZER_H_
#define TESTS_DRIVE_LOCAL_LOCALIZER_H_

#include <deque>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/drive/robot_eyes.h"
#include "client/pilot/pilot.h"
#include "client/simulator/route.h"
#include "homing/journey/journey_map.h"
#include "homing/localization/localizer.h"

namespace homing::drive {

struct OutboundDrive {
  double length_m = 60;
  double speed_mps = 4 / 3.6;
  double fps = 10;
};

// What a robot records that follows the route.
absl::StatusOr<JourneyMap> RecordOut(const client::Route& route, const OutboundDrive& drive,
                                     client::RobotEyes* eyes);

// One homing robot's stream.
class LocalLocalizer {
 public:
  // The robot knows that it stands where its way out ended. `map` must outlive it.
  LocalLocalizer(const JourneyMap* map, Travel travel);

  absl::StatusOr<client::PilotAnswer> Answer(const Observation& seen);
  // As a client does when its server was killed: a new stream begins from the belief of 64
  // observations ago, and these are sent again. REQUIRES: observations are flow vectors.
  absl::Status Restart();

 private:
  static constexpr std::size_t kReplay = 64;
  struct Kept {
    Observation observation;
    // Before it.
    PositionPrior prior;
  };

  Localizer Fresh() const;

  std::string name_ = "robots/a/journeys/b";
  JourneyRef journey_;
  Travel travel_;
  Localizer localizer_;
  PositionPrior prior_;
  std::deque<Kept> kept_;
};

}  // namespace homing::drive

#endif  // TESTS_DRIVE_LOCAL_LOCALIZER_H_
