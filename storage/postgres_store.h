// The store on PostgreSQL (storage/postgres/).
#ifndef STORAGE_POSTGRES_STORE_H_
#define STORAGE_POSTGRES_STORE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "storage/journey_store.h"

namespace homing::storage {

// The schema that this program writes.
inline constexpr int kPostgresSchemaVersion = 1;

// As OpenJourneyStore. REQUIRES: IsPostgresUrl(options.url).
absl::StatusOr<std::unique_ptr<JourneyStore>> OpenPostgresStore(const StoreOptions& options);

}  // namespace homing::storage

#endif  // STORAGE_POSTGRES_STORE_H_
