#include "client/simulator/simulation_spec.h"

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/simulator/seeded_random.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr char kPrefix[] = "sim:";

struct NumberKey {
  const char* name;
  double SimulationSpec::*field;
  double low;
  double high;
  const char* limit;
  // The key can be left out, which is the same as 0.
  bool is_optional = false;
  bool is_whole = false;
};
constexpr std::array<NumberKey, 18> kNumberKeys = {{
    {"length", &SimulationSpec::length_m, 1, 100000, "metres in [1, 100000]"},
    {"fps", &SimulationSpec::fps, 0.1, 240, "frames a second in [0.1, 240]"},
    {"speed", &SimulationSpec::speed_kmh, 0.1, 100, "km/h in [0.1, 100]"},
    {"offset", &SimulationSpec::offset_m, -5, 5, "metres to the left in [-5, 5]"},
    {"light", &SimulationSpec::light, 0.1, 4, "a gain in [0.1, 4]"},
    {"noise", &SimulationSpec::noise, 2, 100, "grey levels in [2, 100]"},
    {"remove", &SimulationSpec::remove, 0, 1, "a share in [0, 1]"},
    {"wobble", &SimulationSpec::wobble_m, 0, 2, "metres in [0, 2]"},
    {"stop", &SimulationSpec::stop_s, 0, 3600, "seconds in [0, 3600]"},
    {"vary", &SimulationSpec::vary, 0, 1, "a share in [0, 1]", true},
    {"extra", &SimulationSpec::extra_m, 0, 40, "metres in [0, 40]", true},
    {"yaw", &SimulationSpec::yaw_deg, -180, 180, "degrees in [-180, 180]", true},
    {"yaw_wobble", &SimulationSpec::yaw_wobble_deg, 0, 20, "degrees in [0, 20]", true},
    {"rough", &SimulationSpec::rough_deg, 0, 5, "degrees in [0, 5]", true},
    {"repeat", &SimulationSpec::repeat, 2, 1000, "0 or a whole number in [2, 1000]", true, true},
    {"drop", &SimulationSpec::drop, 0, 0.95, "a share in [0, 0.95]", true},
    {"drop_run", &SimulationSpec::drop_run, 1, 1000, "0 or a whole number in [1, 1000]", true,
     true},
    {"corner", &SimulationSpec::corner_deg, -60, 60, "degrees in [-60, 60]", true},
}};

absl::Status BadValue(const std::string& key, const std::string& value, const std::string& limit) {
  return absl::InvalidArgumentError(
      absl::StrCat("simulation key ", key, " is \"", value, "\"; it must be ", limit));
}

absl::Status CheckNumber(const NumberKey& key, double value) {
  const bool is_in_range = value >= key.low && value <= key.high;
  if ((is_in_range && (!key.is_whole || value == std::floor(value))) ||
      (key.is_optional && value == 0)) {
    return absl::OkStatus();
  }
  return BadValue(key.name, absl::StrCat(value), key.limit);
}

absl::Status ParseNumber(const NumberKey& key, const std::string& value, SimulationSpec& spec) {
  double number = 0;
  if (!absl::SimpleAtod(value, &number) || !std::isfinite(number)) {
    return BadValue(key.name, value, key.limit);
  }
  spec.*key.field = number;
  return CheckNumber(key, number);
}

absl::Status ParseSeed(const std::string& key, const std::string& value, std::uint64_t& seed) {
  if (!absl::SimpleAtoi(value, &seed)) {
    return BadValue(key, value, "a whole number in [0, 18446744073709551615]");
  }
  return absl::OkStatus();
}

absl::Status ParseTravel(const std::string& value, SimulationSpec& spec) {
  if (value != "return" && value != "same") {
    return BadValue("travel", value, "return or same");
  }
  spec.travel_return = value == "return";
  return absl::OkStatus();
}

absl::Status ParseKey(const std::string& key, const std::string& value, SimulationSpec& spec) {
  for (const NumberKey& number : kNumberKeys) {
    if (key == number.name) {
      return ParseNumber(number, value, spec);
    }
  }
  if (key == "seed") {
    return ParseSeed(key, value, spec.seed);
  }
  if (key == "drive") {
    return ParseSeed(key, value, spec.drive_seed);
  }
  if (key == "travel") {
    return ParseTravel(value, spec);
  }
  return absl::InvalidArgumentError(
      absl::StrCat("unknown simulation key \"", key, "\" with value \"", value,
                   "\"; the keys are seed, length, fps, speed, offset, light, noise, remove, "
                   "wobble, stop, vary, extra, yaw, yaw_wobble, rough, repeat, drop, drop_run, "
                   "corner, travel, drive"));
}

absl::Status CheckScene(const std::string& scene) {
  if (scene == "landmarks" || scene == "street") {
    return absl::OkStatus();
  }
  return BadValue("scene", scene, "landmarks or street");
}

}  // namespace

absl::StatusOr<SimulationSpec> ParseSimulationSpec(const std::string& text) {
  const std::string prefix = kPrefix;
  if (text.compare(0, prefix.size(), prefix) != 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("simulation \"", text, "\" must be sim:SCENE[,key=value...]"));
  }
  const std::vector<std::string> parts = absl::StrSplit(text.substr(prefix.size()), ',');
  SimulationSpec spec;
  spec.scene = parts.front();
  HOMING_RETURN_IF_ERROR(CheckScene(spec.scene));
  std::set<std::string> given;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::pair<std::string, std::string> pair =
        absl::StrSplit(parts[i], absl::MaxSplits('=', 1));
    if (!given.insert(pair.first).second) {
      return BadValue(pair.first, pair.second, "given once");
    }
    HOMING_RETURN_IF_ERROR(ParseKey(pair.first, pair.second, spec));
  }
  return spec;
}

absl::Status Validate(const SimulationSpec& spec) {
  HOMING_RETURN_IF_ERROR(CheckScene(spec.scene));
  for (const NumberKey& key : kNumberKeys) {
    HOMING_RETURN_IF_ERROR(CheckNumber(key, spec.*key.field));
  }
  return absl::OkStatus();
}

std::uint64_t DriveSeed(const SimulationSpec& spec) {
  if (spec.drive_seed != 0) {
    return spec.drive_seed;
  }
  std::uint64_t seed = Mix(spec.seed, spec.scene.size(), spec.travel_return ? 1 : 0);
  // A key that is left out changes nothing, so that keys can be added.
  for (std::size_t i = 0; i < kNumberKeys.size(); ++i) {
    const NumberKey& key = kNumberKeys[i];
    const auto bits = std::bit_cast<std::uint64_t>(spec.*key.field);
    if (!key.is_optional) {
      seed = Mix(seed, bits);
    } else if (spec.*key.field != 0) {
      seed = Mix(seed, i, bits);
    }
  }
  return seed;
}

}  // namespace homing::client
