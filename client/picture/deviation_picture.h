// Training of the deviation model: the histogram of deviations with the fitted density (Fig. 1) and
// both cumulative distributions (Fig. 2).
#ifndef CLIENT_PICTURE_DEVIATION_PICTURE_H_
#define CLIENT_PICTURE_DEVIATION_PICTURE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "homing/similarity/deviation_model.h"

namespace homing::client {

// As Canvas. REQUIRES: deviations, pixels, not empty.
absl::Status DrawDeviationDensity(const std::string& path, const std::vector<double>& deviations_px,
                                  const DeviationModel& model);
absl::Status DrawDeviationDistribution(const std::string& path,
                                       const std::vector<double>& deviations_px,
                                       const DeviationModel& model);

}  // namespace homing::client

#endif  // CLIENT_PICTURE_DEVIATION_PICTURE_H_
