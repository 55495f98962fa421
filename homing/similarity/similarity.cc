#include "homing/similarity/similarity.h"

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

MeanAndCount Of(const Fingerprint& f) {
  return {double{f.x}, double{f.y}, static_cast<double>(f.count)};
}

}  // namespace

Similarity Compare(const MeanAndCount& i, const MeanAndCount& j, const DeviationModel& model) {
  Similarity result;
  // Equation (13).
  const double dx = i.x - j.x;
  const double dy = i.y - j.y;
  result.delta = std::sqrt(dx * dx + dy * dy);
  // Equation (14).
  result.p = Survival(model, result.delta);
  // Equation (15).
  if (i.count > 0 && j.count > 0) {
    result.p_t = result.p * (std::min(i.count, j.count) / std::max(i.count, j.count));
  }
  return result;
}

Similarity Compare(const Fingerprint& i, const Fingerprint& j, const DeviationModel& model) {
  return Compare(Of(i), Of(j), model);
}

}  // namespace homing
