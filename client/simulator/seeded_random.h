// Counter-based random numbers: the same key gives the same sequence on every machine, in any
// order. The mixing function is SplitMix64 (Steele, Lea, Flood 2014).
#ifndef CLIENT_SIMULATOR_SEEDED_RANDOM_H_
#define CLIENT_SIMULATOR_SEEDED_RANDOM_H_

#include <cmath>
#include <cstdint>
#include <numbers>

namespace homing::client {

inline std::uint64_t Mix(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31U);
}

inline std::uint64_t Mix(std::uint64_t a, std::uint64_t b) { return Mix(Mix(a) ^ b); }
inline std::uint64_t Mix(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return Mix(Mix(a, b) ^ c);
}

// [0, 1).
inline double ToUnit(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1p-53; }

// Not thread-safe.
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t key) : key_(Mix(key)) {}

  std::uint64_t Bits() { return Mix(key_ + ++count_); }
  double Uniform(double low, double high) { return low + (high - low) * ToUnit(Bits()); }
  int Below(int limit) { return static_cast<int>(Uniform(0, limit)); }
  bool Chance(double probability) { return ToUnit(Bits()) < probability; }
  // Standard normal (Box and Muller 1958).
  double Gaussian() {
    const double radius = std::sqrt(-2 * std::log(1 - Uniform(0, 1)));
    return radius * std::cos(2 * std::numbers::pi * Uniform(0, 1));
  }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SEEDED_RANDOM_H_
