// QUERY pipeline: observations to matches and a position, in the paper's order (III).
#ifndef HOMING_LOCALIZATION_LOCALIZER_H_
#define HOMING_LOCALIZATION_LOCALIZER_H_

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/flow/observation.h"
#include "homing/localization/path_pose.h"
#include "homing/localization/position_filter.h"
#include "homing/matching/matcher.h"

namespace homing {

struct LocalizerOptions {
  Travel travel = Travel::kReturn;
  // This robot's cameras, indexed by Side of the ROBOT; sizes of 0 are filled in.
  std::array<Camera, 2> cameras;
  // Options of the journeys searched.
  FlowOptions flow;
  LandmarkOptions landmark;
  MatchOptions match;
  PositionOptions position;
};

absl::Status Validate(const LocalizerOptions& options);

struct Localization {
  std::int64_t sequence = 0;
  // Observation::frame, else the sequence.
  std::int64_t frame = 0;
  Motion motion = Motion::kMoving;
  // False for the first frame and after a break: nothing could be compared.
  bool has_flow = false;
  // JourneyStep::sequence of position.step.
  std::optional<std::int64_t> step_sequence;
  Position position;
  // Best match within the position's interval, else none.
  std::optional<std::int32_t> landmark;
  std::optional<double> similarity;
  std::vector<Match> matches;
  // Change of the heading relative to the outbound path since the last step, to the robot's left:
  // rad if a focal length is known, else pixels. It includes corrections of earlier errors, so that
  // the sum is the heading relative to the path. Absent without two cameras that look across the
  // direction of travel.
  std::optional<double> turn;
};

// OK if `query` may be localised on a journey of `settings`: image sizes agree side by side of the
// route, flow and landmark options agree. FAILED_PRECONDITION naming what differs.
absl::Status CheckCompatible(const LocalizerOptions& query, const JourneySettings& settings);

// One homing robot. Not thread-safe.
class Localizer {
 public:
  // REQUIRES: Validate(options).ok().
  explicit Localizer(const LocalizerOptions& options, const DecodeLimits& limits = {});

  // As PositionFilter::Start.
  absl::Status Start(std::span<const JourneyRef> journeys, const PositionPrior& prior);

  // An observation that makes no step is kStanding, has no matches and leaves the belief as it is.
  // `journeys` as in PositionFilter::Update. INVALID_ARGUMENT: as ObservationFlow.
  // FAILED_PRECONDITION: image size unlike the journeys'. After an error the state is as before.
  absl::StatusOr<Localization> Localize(const Observation& observation,
                                        std::span<const JourneyRef> journeys);

  // As PositionFilter::masses.
  const std::vector<StepMass>& masses() const { return filter_.masses(); }

 private:
  // This robot's cameras, with the sizes that they must have. FAILED_PRECONDITION.
  absl::StatusOr<std::array<Camera, 2>> CamerasFor(std::span<const JourneyRef> journeys) const;
  SeenProfiles MakeRouteProfiles(const ObservedFlow& flow, Motion motion) const;
  // Moves the pose beside the path, and returns the flow that a robot heading along the path would
  // have seen.
  ObservedFlow FollowPath(std::span<const JourneyRef> journeys, const ObservedFlow& flow,
                          Motion motion);
  // Writes the pose beside the path, and the turn relative to the path, into the answer.
  void ReportPose(const ObservedFlow& flow, Localization& result);
  void ReportLandmark(std::span<const JourneyRef> journeys, const SeenSides& seen,
                      Localization& result);

  LocalizerOptions options_;
  ObservationFlow flow_;
  PositionFilter filter_;
  PathPoseFilter path_;
  // P_T that as many landmarks as are reported probably reach at the next observation.
  double likely_match_ = 0;
  // Sum of the reported turns, rad.
  double reported_heading_ = 0;
  // The answer to the last step.
  std::optional<Localization> last_;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_LOCALIZER_H_
