// Whether a journey that is to be created is the one that exists.
#ifndef SERVER_CATALOG_SAME_JOURNEY_H_
#define SERVER_CATALOG_SAME_JOURNEY_H_

#include "storage/journey_store.h"

namespace homing::server {

// `present` is active and has the same writer_id (not empty), settings and readers (in any order).
bool IsSameJourney(const storage::JourneyRecord& wanted, const storage::JourneyRecord& present);

}  // namespace homing::server

#endif  // SERVER_CATALOG_SAME_JOURNEY_H_
