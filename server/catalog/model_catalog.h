// Deviation models by name: the built-in one and trained ones.
#ifndef SERVER_CATALOG_MODEL_CATALOG_H_
#define SERVER_CATALOG_MODEL_CATALOG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "storage/journey_store.h"

namespace homing::server {

inline constexpr char kDefaultModelName[] = "deviationModels/default";

struct TrainedModel {
  storage::StoredModel stored;
  // chi_k (eq 8), pixels.
  std::vector<double> deviations_px;
};

// Thread-safe.
class ModelCatalog {
 public:
  // `store` must outlive the catalog.
  explicit ModelCatalog(storage::JourneyStore* store) : store_(store) {}

  // Trains and stores a model; the same settings return the stored one. `now_ns` is the server's
  // clock. INVALID_ARGUMENT; ALREADY_EXISTS: it has other settings, or is "default".
  absl::StatusOr<TrainedModel> Train(const std::string& model_id, const TrainingOptions& options,
                                     std::int64_t now_ns);
  // INVALID_ARGUMENT, NOT_FOUND.
  absl::StatusOr<storage::StoredModel> Get(const std::string& name);
  // In order of name, after `after`; at most `limit`.
  absl::StatusOr<std::vector<storage::StoredModel>> List(const std::string& after, int limit);

 private:
  storage::JourneyStore* const store_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_MODEL_CATALOG_H_
