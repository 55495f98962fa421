#include "server/catalog/journey_errors.h"

#include "absl/strings/str_cat.h"
#include "server/base/error_reason.h"

namespace homing::server {

absl::Status WriterReplaced(const std::string& journey) {
  return WithReason(absl::AbortedError(absl::StrCat(
                        "journey: \"", journey,
                        "\" was taken over by another stream; only one stream may write it")),
                    {"WRITER_REPLACED", {}});
}

absl::Status JourneyDeleted(const std::string& journey) {
  return WithReason(absl::AbortedError(absl::StrCat("journey: \"", journey, "\" was deleted")),
                    {"JOURNEY_DELETED", {}});
}

absl::Status JourneyFinished(const std::string& journey) {
  return WithReason(absl::FailedPreconditionError(absl::StrCat(
                        "journey: \"", journey, "\" is finished and takes no observations")),
                    {"JOURNEY_FINISHED", {}});
}

}  // namespace homing::server
