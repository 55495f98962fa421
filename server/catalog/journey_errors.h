// Errors that end a writer's stream.
#ifndef SERVER_CATALOG_JOURNEY_ERRORS_H_
#define SERVER_CATALOG_JOURNEY_ERRORS_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// ABORTED: another stream writes the journey now.
absl::Status WriterReplaced(const std::string& journey);
// ABORTED.
absl::Status JourneyDeleted(const std::string& journey);
// FAILED_PRECONDITION.
absl::Status JourneyFinished(const std::string& journey);

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_ERRORS_H_
