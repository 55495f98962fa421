// Settings as canonical JSON text: keys sorted, no blanks, numbers that read back to the same bits.
#ifndef STORAGE_SETTINGS_JSON_H_
#define STORAGE_SETTINGS_JSON_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/journey/journey_settings.h"
#include "homing/similarity/deviation_training.h"

namespace homing::storage {

std::string ToJson(const JourneySettings& settings);
std::string ToJson(const TrainingOptions& options);
std::string ToJson(const std::vector<std::string>& names);

// DATA_LOSS: not JSON, a field missing or of another type.
absl::StatusOr<JourneySettings> JourneySettingsFromJson(const std::string& text);
absl::StatusOr<TrainingOptions> TrainingOptionsFromJson(const std::string& text);
absl::StatusOr<std::vector<std::string>> NamesFromJson(const std::string& text);

}  // namespace homing::storage

#endif  // STORAGE_SETTINGS_JSON_H_
