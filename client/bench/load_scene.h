// The observations that the robots of a load send.
#ifndef CLIENT_BENCH_LOAD_SCENE_H_
#define CLIENT_BENCH_LOAD_SCENE_H_

#include <vector>

#include "absl/status/statusor.h"
#include "homing/v1/types.pb.h"

namespace homing::client {

// The observations of one route, made once and sent repeatedly. Immutable.
class LoadScene {
 public:
  // Flow vectors of the left camera on a simulated street. Each route is another street; each drive
  // along it has its own noise and clutter.
  static LoadScene WithFlow(int route, int drive, int steps, int vectors);
  // Frames of the simulated street, left camera.
  static absl::StatusOr<LoadScene> WithFrames(int count);

  // Without sequences.
  const std::vector<v1::Observation>& observations() const { return observations_; }

 private:
  std::vector<v1::Observation> observations_;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_LOAD_SCENE_H_
