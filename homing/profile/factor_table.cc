#include "homing/profile/factor_table.h"

namespace homing {
namespace {

// ln of the distance beyond which 1 - F is below `floor`, by bisection.
double LogFurthest(const DeviationModel& model, double floor) {
  double near = -50;
  double far = 50;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    (Survival(model, std::exp(middle)) >= floor ? near : far) = middle;
  }
  return far;
}

}  // namespace

FactorTable::FactorTable(const DeviationModel& model, double floor)
    : floor_(static_cast<float>(floor)) {
  const double furthest = std::exp(LogFurthest(model, floor));
  entries_per_px_ = static_cast<float>(double{kEntries} / furthest);
  const auto entries = static_cast<std::size_t>(kEntries);
  survival_.reserve(entries + 1);
  for (std::size_t i = 0; i <= entries; ++i) {
    const double delta = furthest * static_cast<double>(i) / double{kEntries};
    survival_.push_back(static_cast<float>(Survival(model, delta)));
  }
}

}  // namespace homing
