#include "client/drive/home_drive.h"

#include <cmath>
#include <deque>

#include "client/simulator/seeded_random.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

double Wrapped(double angle) { return std::remainder(angle, kTurn); }

class Drive {
 public:
  Drive(const HomeDriveOptions& options, const Route& route, RobotEyes* eyes,
        const Answering& answering, const OnOutage& on_outage)
      : options_(options),
        route_(route),
        eyes_(eyes),
        answering_(answering),
        on_outage_(on_outage),
        pilot_(options.pilot),
        robot_(options.robot, StartOf(options, route)) {}

  absl::StatusOr<HomeDrive> Run() {
    const double frame_s = 1 / options_.fps;
    for (std::int64_t frame = 0; robot_.time_s() < options_.most_s; ++frame) {
      HOMING_RETURN_IF_ERROR(Disturb());
      DrivenPoint point = PointNow();
      if (robot_.time_s() >= outage_until_s_) {
        HOMING_ASSIGN_OR_RETURN(point.answer, Ask(frame));
      }
      DriveFor(frame_s, point);
      drive_.points.push_back(point);
      if (pilot_.state() == Pilot::State::kHome) {
        if (drive_.stopped) break;
        drive_.stopped = true;
      }
    }
    return std::move(drive_);
  }

 private:
  // Commands a second.
  static constexpr double kCommandS = 0.05;

  static Pose StartOf(const HomeDriveOptions& options, const Route& route) {
    Pose pose = route.At(options.pilot.route_m);
    pose.position = pose.At(options.start_ahead_m, options.start_left_m);
    pose.heading += options.start_heading;
    return pose;
  }

  DrivenPoint PointNow() const {
    DrivenPoint point;
    point.time_s = robot_.time_s();
    point.pose = robot_.pose();
    point.route_m = route_.Nearest(point.pose.position);
    const Pose on_path = route_.At(point.route_m);
    point.left_m = (point.pose.position - on_path.position).dot(on_path.Left());
    const double way = options_.pilot.turn_round ? on_path.heading + kTurn / 2 : on_path.heading;
    point.heading = Wrapped(point.pose.heading - way);
    point.state = pilot_.state();
    point.believed_left_m = pilot_.offset_m();
    point.believed_heading = pilot_.heading();
    point.believed_home_m = pilot_.remaining_m();
    return point;
  }

  // Carries the robot away, and breaks the link, where the options say so.
  absl::Status Disturb() {
    const double driven_m = options_.pilot.route_m - route_.Nearest(robot_.pose().position);
    if (!is_carried_ && options_.carried_at_m >= 0 && driven_m >= options_.carried_at_m) {
      is_carried_ = true;
      const DrivenPoint from = PointNow();
      Pose pose = route_.At(from.route_m - options_.carried_m);
      const double turned = Wrapped(from.pose.heading - route_.At(from.route_m).heading);
      pose.position = pose.At(0, from.left_m);
      pose.heading += turned;
      robot_.SetDown(pose);
    }
    if (outage_until_s_ < 0 && options_.outage_at_m >= 0 && driven_m >= options_.outage_at_m) {
      outage_until_s_ = robot_.time_s() + options_.outage_s;
      if (on_outage_) return on_outage_();
    }
    return absl::OkStatus();
  }

  absl::StatusOr<PilotAnswer> Ask(std::int64_t frame) {
    Observation seen = eyes_->See(robot_.pose(), options_.first_frame + frame);
    seen.sequence = sequence_++;
    HOMING_ASSIGN_OR_RETURN(PilotAnswer answer, answering_(seen));
    answer.sequence = seen.sequence;
    answer.time_s = robot_.time_s();
    SeededRandom random(Mix(options_.seed, 93, static_cast<std::uint64_t>(seen.sequence)));
    if (!random.Chance(options_.lost)) on_the_way_.push_back(answer);
    return answer;
  }

  // Drives until the next frame; the pilot gets the answers that arrive meanwhile.
  void DriveFor(double seconds, DrivenPoint& point) {
    const long commands = std::max(1L, std::lround(seconds / kCommandS));
    for (long i = 0; i < commands; ++i) {
      const double now_s = robot_.time_s();
      while (!on_the_way_.empty() && on_the_way_.front().time_s + options_.delay_s <= now_s) {
        pilot_.Take(Blindfolded(on_the_way_.front()));
        on_the_way_.pop_front();
      }
      point.command = pilot_.Drive(now_s);
      robot_.Drive({point.command.speed_mps, point.command.turn_rate},
                   seconds / static_cast<double>(commands));
    }
  }

  PilotAnswer Blindfolded(PilotAnswer answer) const {
    if (options_.blindfolded && pilot_.state() != Pilot::State::kTurningRound) {
      if (answer.turn) answer.turn = 0;
      if (answer.path_offset) answer.path_offset = 0;
      if (answer.speed_ratio) answer.speed_ratio = -1;
    }
    return answer;
  }

  HomeDriveOptions options_;
  const Route& route_;
  RobotEyes* eyes_;
  const Answering& answering_;
  const OnOutage& on_outage_;
  Pilot pilot_;
  WheeledRobot robot_;
  std::deque<PilotAnswer> on_the_way_;
  std::int64_t sequence_ = 0;
  double outage_until_s_ = -1;
  bool is_carried_ = false;
  HomeDrive drive_;
};

}  // namespace

double HomeDrive::EndFromHome(const Route& route) const {
  return points.empty() ? kNothing : cv::norm(points.back().pose.position - route.At(0).position);
}

absl::StatusOr<HomeDrive> DriveHome(const HomeDriveOptions& options, const Route& route,
                                    RobotEyes* eyes, const Answering& answering,
                                    const OnOutage& on_outage) {
  return Drive(options, route, eyes, answering, on_outage).Run();
}

}  // namespace homing::client
