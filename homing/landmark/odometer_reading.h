// How far one camera moved between two frames, as its flow shows it. At the same place the flow is
// in proportion to the robot's motion, so that the ratio of two readings is a number of steps
// (docs/algorithm.md, The flow as an odometer).
#ifndef HOMING_LANDMARK_ODOMETER_READING_H_
#define HOMING_LANDMARK_ODOMETER_READING_H_

#include <cstdint>
#include <optional>

#include "homing/flow/flow_vector.h"

namespace homing {

// Immutable value of eight bytes, rounded once at creation: memory, disk and wire hold the same.
// Lengths are pixels of the source image.
struct OdometerReading {
  // Units of the signed values: 1/32 px.
  static constexpr double kSignedPerPx = 32;
  // A length code is 1 + 20 (log2(px) + 4), rounded: 3.5 % a code, from 1/16 px to 420 px.
  static constexpr double kCodesPerOctave = 20;
  static constexpr double kLeastLog2Px = -4;
  // Fewer vectors give no reading.
  static constexpr int kLeastVectors = 8;

  // Median x displacement; the sign is the side to which the image moves.
  std::int16_t median_x = 0;
  // Expansion: displacement away from the median midpoint, px per image width of distance from it.
  // Positive when the camera approaches what it sees.
  std::int16_t expansion = 0;
  // Codes of the median length, and of the median distance of the vectors from their median, which
  // no rotation changes much. 0: no reading.
  std::uint8_t length_code = 0;
  std::uint8_t spread_code = 0;
  // Turn of the camera to the left, as the vertical flow shows it: TurnCode. 0: no reading.
  std::int16_t turn_code = 0;

  // Units of a turn: 1/16384 rad. A turn below half a unit counts as one.
  static constexpr double kTurnPerRad = 16384;
  static std::int16_t TurnCode(double turn);
  std::optional<double> turn() const;

  bool has_value() const { return length_code != 0; }
  friend bool operator==(const OdometerReading&, const OdometerReading&) = default;
};

// No value for fewer than kLeastVectors finite vectors.
OdometerReading ReadOdometer(const FlowField& field);
// Its median_x alone.
std::optional<std::int16_t> ReadMedianX(const FlowField& field);

}  // namespace homing

#endif  // HOMING_LANDMARK_ODOMETER_READING_H_
