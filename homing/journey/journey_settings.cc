#include "homing/journey/journey_settings.h"

#include "absl/strings/match.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {

absl::Status Validate(const JourneySettings& settings) {
  HOMING_RETURN_IF_ERROR(Within("left_camera", Validate(settings.cameras[0])));
  HOMING_RETURN_IF_ERROR(Within("right_camera", Validate(settings.cameras[1])));
  HOMING_RETURN_IF_ERROR(Within("flow", Validate(settings.flow)));
  HOMING_RETURN_IF_ERROR(Within("landmark", Validate(settings.landmark)));
  if (!absl::StartsWith(settings.deviation_model_name, "deviationModels/")) {
    return TextMustBe("deviation_model", settings.deviation_model_name, "deviationModels/{model}");
  }
  return Within("deviation_model", Validate(settings.deviation_model));
}

}  // namespace homing
