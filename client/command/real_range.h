// Checks real numbers on the command line.
#ifndef CLIENT_COMMAND_REAL_RANGE_H_
#define CLIENT_COMMAND_REAL_RANGE_H_

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

namespace homing::client {

// As CLI::Range, which accepts "nan".
inline CLI::Validator RealRange(double low, double high) {
  const CLI::Range range(low, high);
  const auto check = [range](std::string& text) {
    std::string error = range(text);
    if (error.empty() && std::isnan(std::strtod(text.c_str(), nullptr))) {
      error = "Value " + text + " is not a number";
    }
    return error;
  };
  return {check, range.get_description()};
}

}  // namespace homing::client

#endif  // CLIENT_COMMAND_REAL_RANGE_H_
