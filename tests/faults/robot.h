// A robot that records journey after journey through whatever happens to the server.
#ifndef TESTS_FAULTS_ROBOT_H_
#define TESTS_FAULTS_ROBOT_H_

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/observation_stream.h"
#include "tests/faults/ledger.h"

namespace homing::faults {

struct RobotOptions {
  std::string address;
  // The robot's number. Each has its own route.
  int robot = 0;
  // One in so many sends frames, the others flow vectors.
  int frames_every = 2;
  bool sends_frames() const { return robot % frames_every == frames_every - 1; }
  int observations = 60;
  // Between two observations, as of a camera.
  std::chrono::milliseconds pace{4};
  // How long the server may be away.
  std::chrono::milliseconds retry_for{120'000};
  // Called with each observation answered, and the time since it was handed over.
  std::function<void(std::chrono::microseconds)> on_answer = [](auto) {};
  // Called with each step that the robot or its client takes between answers.
  std::function<void(const std::string&)> log = [](auto&) {};
};

// The observations of a robot's route: the same each time.
std::unique_ptr<client::ObservationStream> RouteOf(const RobotOptions& options);

// Creates, records and finishes one journey; reports acknowledged observations to `ledger`.
absl::Status RecordOne(const RobotOptions& options, const std::string& journey, Ledger* ledger);

// Localises on a journey along the robot's own route. OUT: the share of the answers that are MATCH.
absl::StatusOr<double> LocalizeOn(const RobotOptions& options, const std::string& journey);

// The bytes of the exported map.
absl::StatusOr<std::string> ExportOne(const std::string& address, const std::string& journey);
absl::Status DeleteOne(const RobotOptions& options, const std::string& journey);

// "robots/{robot}/journeys/{number}".
std::string JourneyOf(int robot, int number);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_ROBOT_H_
