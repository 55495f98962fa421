// A synthetic route for tests of the session layer and the server: the cameras' views at each
// place, as flow vectors or as frames. Deterministic.
#ifndef TESTS_SUPPORT_ROUTE_H_
#define TESTS_SUPPORT_ROUTE_H_

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "homing/flow/flow_vector.h"
#include "homing/flow/observation.h"

namespace homing::test {

inline constexpr int kWidth = 160;
inline constexpr int kHeight = 120;

// Of integers, 0..1.
inline double Noise(std::uint32_t a, std::uint32_t b, std::uint32_t c = 0) {
  std::uint32_t h = a * 0x9E3779B1u + b * 0x85EBCA77u + c * 0xC2B2AE3Du;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return static_cast<double>(h ^ (h >> 15)) / 4294967295.0;
}

// One landmark's vectors at a place: its mean drifts through the image, and another follows it;
// height and number are its own.
inline FlowField FieldAt(int place, Side side, int width = kWidth, int height = kHeight) {
  constexpr int kPlacesALandmark = 20;
  const auto landmark =
      static_cast<std::uint32_t>(place / kPlacesALandmark) * 2 + static_cast<std::uint32_t>(side);
  const double x = width * (0.7 - 0.4 * (place % kPlacesALandmark) / kPlacesALandmark);
  const double y = height * (0.25 + 0.5 * Noise(landmark, 1));
  const int count = 20 + static_cast<int>(60 * Noise(landmark, 2));
  FlowField field{width, height, {}};
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::uint32_t>(i);
    const auto start_x = static_cast<float>(x + 20 * (Noise(landmark, n, 3) - 0.5));
    const auto start_y = static_cast<float>(y + 20 * (Noise(landmark, n, 4) - 0.5));
    const auto length = static_cast<float>(2 + Noise(landmark, n, 5));
    field.vectors.push_back({start_x, start_y, start_x - length, start_y});
  }
  return field;
}

// Flow vectors of both cameras on the way out.
inline Observation FlowAt(std::int64_t sequence, int place) {
  Observation observation;
  observation.sequence = sequence;
  observation.views = {FieldAt(place, Side::kLeft), FieldAt(place, Side::kRight)};
  return observation;
}
inline Observation FlowAt(std::int64_t sequence) {
  return FlowAt(sequence, static_cast<int>(sequence));
}

// Grey bytes of a camera that passes a rough wall, 3 px a place.
inline std::string WallAt(int place, Side side, int width = kWidth, int height = kHeight) {
  constexpr int kCell = 6;
  constexpr int kPixelsAPlace = 3;
  const auto wall = static_cast<std::uint32_t>(side) + 7;
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(width * height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = static_cast<double>(x + kPixelsAPlace * place) / kCell;
      const double v = static_cast<double>(y) / kCell;
      const auto iu = static_cast<std::uint32_t>(u);
      const auto iv = static_cast<std::uint32_t>(v);
      const double fu = u - iu;
      const double fv = v - iv;
      const double top = Noise(iu, iv, wall) * (1 - fu) + Noise(iu + 1, iv, wall) * fu;
      const double low = Noise(iu, iv + 1, wall) * (1 - fu) + Noise(iu + 1, iv + 1, wall) * fu;
      bytes.push_back(
          static_cast<char>(static_cast<unsigned char>(20 + 215 * (top * (1 - fv) + low * fv))));
    }
  }
  return bytes;
}

// A frame of one camera with its bytes, for an Observation's view.
// A frame only views its bytes.
Frame GrayFrame(std::string&& bytes, int width = kWidth, int height = kHeight) = delete;
inline Frame GrayFrame(const std::string& bytes, int width = kWidth, int height = kHeight) {
  return Frame{FrameEncoding::kGray8, width, height, bytes};
}

}  // namespace homing::test

#endif  // TESTS_SUPPORT_ROUTE_H_
