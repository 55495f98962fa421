#include "homing/localization/localizer.h"

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/flow/rotation_fit.h"

namespace homing {
namespace {

absl::Status CheckSize(std::size_t index, const Camera& camera, const Camera& recorded) {
  if (camera.width == 0 || recorded.width == 0 ||
      (camera.width == recorded.width && camera.height == recorded.height)) {
    return absl::OkStatus();
  }
  return absl::FailedPreconditionError(absl::StrCat(
      kCameraNames[index], " image is ", camera.width, "x", camera.height, ", must be ",
      recorded.width, "x", recorded.height, " as recorded on the side of the route that it sees"));
}

// The turn, rad to the left; nothing unless both cameras have enough flow.
std::optional<double> TurnOnSpot(const ObservedFlow& flow, const std::array<Camera, 2>& cameras) {
  double turn = 0;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const auto& field = flow.fields[camera];
    if (!field || field->vectors.size() < kMinVectors) return std::nullopt;
    turn += 0.5 * FitRotation(*field, cameras[camera]).pan;
  }
  return turn;
}

// A matcher keeps some memory for each landmark of the map: robots that take turns share one.
Matcher& MatcherOfThread() {
  static thread_local Matcher matcher;
  return matcher;
}

// The next observation's matches are probably at least this part as good as the last ones.
constexpr double kLikely = 0.9;

// P_T of the last match that there was room for; 0 if there was more room.
double LeastOf(const std::vector<Match>& matches, const MatchOptions& options) {
  return std::ssize(matches) < options.max_matches ? 0 : matches.back().similarity.p_t;
}

}  // namespace

absl::Status Validate(const LocalizerOptions& options) {
  HOMING_RETURN_IF_ERROR(Within("left_camera", Validate(options.cameras[0])));
  HOMING_RETURN_IF_ERROR(Within("right_camera", Validate(options.cameras[1])));
  HOMING_RETURN_IF_ERROR(Within("flow", Validate(options.flow)));
  HOMING_RETURN_IF_ERROR(Within("landmark", Validate(options.landmark)));
  HOMING_RETURN_IF_ERROR(Within("match", Validate(options.match)));
  return Within("position", Validate(options.position));
}

absl::Status CheckCompatible(const LocalizerOptions& query, const JourneySettings& settings) {
  if (!(query.flow == settings.flow)) {
    return absl::FailedPreconditionError("flow options differ from the journey's");
  }
  if (!(query.landmark == settings.landmark)) {
    return absl::FailedPreconditionError("landmark options differ from the journey's");
  }
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const auto index = static_cast<std::size_t>(camera);
    const auto side = static_cast<std::size_t>(RouteSide(camera, query.travel));
    HOMING_RETURN_IF_ERROR(CheckSize(index, query.cameras[index], settings.cameras[side]));
  }
  return absl::OkStatus();
}

Localizer::Localizer(const LocalizerOptions& options, const DecodeLimits& limits)
    : options_(options),
      flow_(options.flow, limits),
      filter_(options.position),
      path_(options.travel, options.cameras) {}

absl::StatusOr<Localization> Localizer::Localize(const Observation& observation,
                                                 std::span<const JourneyRef> journeys) {
  // II-B, equations (1) to (5): corners, and their flow since the reference frame.
  HOMING_ASSIGN_OR_RETURN(const auto cameras, CamerasFor(journeys));
  HOMING_ASSIGN_OR_RETURN(const ObservedFlow flow, flow_.Compute(observation, cameras));
  flow_.FillSizes(options_.cameras);
  const bool has_flow = flow.fields[0].has_value() || flow.fields[1].has_value();
  // Added to the paper: nothing moved enough since the reference, so the belief stays as it is.
  if (!flow.makes_step && last_) {
    Localization same = *last_;
    same.sequence = observation.sequence;
    same.frame = observation.frame.value_or(observation.sequence);
    same.motion = Motion::kStanding;
    same.has_flow = has_flow;
    same.turn.reset();
    return same;
  }
  Localization result;
  result.sequence = observation.sequence;
  result.frame = observation.frame.value_or(observation.sequence);
  result.has_flow = has_flow;
  // III, Fig. 4, equations (11), (12): landmarks, by the side of the route that they are on.
  const SeenStep seen = SeeLandmarks(flow, options_.cameras, options_.travel, options_.landmark);
  result.motion = seen.motion;
  // III, equations (13) to (15), over all stored landmarks.
  result.matches =
      MatcherOfThread().Find(journeys, seen.landmarks, options_.match, nullptr, likely_match_);
  likely_match_ = kLikely * LeastOf(result.matches, options_.match);
  // V, future work: the robot's place by the sequence of its views.
  const ObservedFlow straight = FollowPath(journeys, seen.flow, seen.motion);
  const SeenProfiles profiles = MakeRouteProfiles(straight, seen.motion);
  result.position = filter_.Update(journeys, seen.motion, seen.landmarks, profiles);
  ReportPose(seen.flow, result);
  ReportLandmark(journeys, seen.landmarks, result);
  last_ = result;
  last_->matches.clear();
  return result;
}

absl::Status Localizer::Start(std::span<const JourneyRef> journeys, const PositionPrior& prior) {
  PositionPrior of_route = prior;
  if (options_.travel == Travel::kReturn && prior.path_offset) {
    of_route.path_offset = -*prior.path_offset;
  }
  return filter_.Start(journeys, of_route);
}

ObservedFlow Localizer::FollowPath(std::span<const JourneyRef> journeys, const ObservedFlow& flow,
                                   Motion motion) {
  path_.Begin(options_.cameras);
  if (motion != Motion::kMoving || !last_ || !last_->position.step) return flow;
  const JourneyMap& map = *journeys[static_cast<std::size_t>(last_->position.journey)].map;
  if (!path_.Predict(map, *last_->position.step, flow)) return flow;
  path_.Correct(map, *last_->position.step, flow);
  return path_.Straighten(flow);
}

void Localizer::ReportPose(const ObservedFlow& flow, Localization& result) {
  result.position.path_offset.reset();
  const auto report_heading = [&] {
    result.turn = path_.pose().heading - reported_heading_;
    reported_heading_ = path_.pose().heading;
  };
  if (result.motion == Motion::kTurning) {
    result.turn = TurnOnSpot(flow, options_.cameras);
    if (result.turn) {
      path_.Turn(*result.turn);
      // Before the robot has driven, its heading is not known: the first report after that includes
      // these turns.
      reported_heading_ = path_.knows_heading() ? reported_heading_ + *result.turn : 0;
    } else if (path_.TurnAlone(flow)) {
      // One camera sees too little.
      report_heading();
    }
  } else if (!result.position.step) {
    // Where the place was still known before this observation, the pose has its turn already.
    if (path_.has_motion() || path_.TurnAlone(flow)) report_heading();
    path_.Forget();
  } else if (path_.has_motion()) {
    report_heading();
    if (path_.is_started()) result.position.path_offset = path_.pose().offset;
  } else if (path_.TurnAlone(flow)) {
    report_heading();
  }
  if (result.turn && !options_.cameras[0].intrinsics) {
    *result.turn *= UsualFocal(options_.cameras[0].width);
  }
}

absl::StatusOr<std::array<Camera, 2>> Localizer::CamerasFor(
    std::span<const JourneyRef> journeys) const {
  LocalizerOptions query = options_;
  for (const JourneyRef& journey : journeys) {
    HOMING_RETURN_IF_ERROR(CheckCompatible(query, journey.map->settings()));
    for (const Side camera : {Side::kLeft, Side::kRight}) {
      Camera& mine = query.cameras[static_cast<std::size_t>(camera)];
      const auto side = static_cast<std::size_t>(RouteSide(camera, query.travel));
      const Camera& recorded = journey.map->settings().cameras[side];
      if (mine.width == 0) {
        mine.width = recorded.width;
        mine.height = recorded.height;
      }
    }
  }
  return query.cameras;
}

SeenProfiles Localizer::MakeRouteProfiles(const ObservedFlow& flow, Motion motion) const {
  SeenProfiles seen;
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const auto& field = flow.fields[static_cast<std::size_t>(camera)];
    if (field && motion == Motion::kMoving) {
      seen[static_cast<std::size_t>(RouteSide(camera, options_.travel))].emplace(*field);
    }
  }
  return seen;
}

void Localizer::ReportLandmark(std::span<const JourneyRef> journeys, const SeenSides& seen,
                               Localization& result) {
  const Position& position = result.position;
  if (!position.step) {
    return;
  }
  result.step_sequence =
      journeys[static_cast<std::size_t>(position.journey)].map->sequence(*position.step);
  const auto best = MatcherOfThread().FindBestWithin(
      journeys[static_cast<std::size_t>(position.journey)], position.interval_first,
      position.interval_last, seen, options_.match.threshold);
  if (best) {
    result.landmark = best->landmark;
    result.similarity = best->similarity.p_t;
  }
}

}  // namespace homing
