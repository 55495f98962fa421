#include "client/simulator/landmark_list.h"

#include <algorithm>
#include <cstddef>

#include "client/simulator/seeded_random.h"

namespace homing::client {

std::vector<Surface> Numbered(std::vector<PlacedLandmark> landmarks, std::uint64_t seed,
                              double remove) {
  std::stable_sort(
      landmarks.begin(), landmarks.end(),
      [](const PlacedLandmark& a, const PlacedLandmark& b) { return a.route_m < b.route_m; });
  std::vector<Surface> surfaces;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (ToUnit(Mix(seed, 4242, i)) < remove) {
      continue;
    }
    for (const Shape& shape : landmarks[i].shapes) {
      surfaces.push_back({shape, landmarks[i].material, static_cast<int>(i), landmarks[i].route_m});
    }
  }
  return surfaces;
}

}  // namespace homing::client
