#include "storage/model_rows.h"

#include <algorithm>

#include "homing/base/status_macros.h"
#include "storage/settings_json.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

#define HOMING_MODEL_COLUMNS \
  "name, mu, sigma, observations, ks_distance, width, height, training, create_time_ns"

constexpr char kInsertModel[] = "INSERT INTO deviation_models (" HOMING_MODEL_COLUMNS
                                ") VALUES (?,?,?,?,?,?,?,?,?) ON CONFLICT DO NOTHING";
constexpr char kFindModel[] =
    "SELECT " HOMING_MODEL_COLUMNS " FROM deviation_models WHERE name = ?";
constexpr char kListModels[] =
    "SELECT " HOMING_MODEL_COLUMNS " FROM deviation_models WHERE name > ? ORDER BY name LIMIT ?";

absl::StatusOr<StoredModel> ReadModelRow(Query& query) {
  StoredModel stored;
  stored.name = query.Text(0);
  stored.model.mu = query.Real(1);
  stored.model.sigma = query.Real(2);
  stored.model.observations = static_cast<int>(query.Integer(3));
  stored.model.ks_distance = query.Real(4);
  stored.model.width = static_cast<int>(query.Integer(5));
  stored.model.height = static_cast<int>(query.Integer(6));
  HOMING_ASSIGN_OR_RETURN(stored.training, TrainingOptionsFromJson(query.Text(7)));
  stored.create_time_ns = query.Integer(8);
  return stored;
}

}  // namespace

absl::Status InsertModel(Connection& connection, const StoredModel& model) {
  const int inserted =
      connection
          .Prepare(kInsertModel, model.name, model.model.mu, model.model.sigma,
                   model.model.observations, model.model.ks_distance, model.model.width,
                   model.model.height, ToJson(model.training), model.create_time_ns)
          .Run();
  if (inserted > 0) return absl::OkStatus();
  return ModelExists(model.name);
}

absl::StatusOr<StoredModel> FindModel(Connection& connection, const std::string& name) {
  Query query = connection.Prepare(kFindModel, name);
  if (!query.Next()) return ModelNotFound(name);
  return ReadModelRow(query);
}

absl::StatusOr<std::vector<StoredModel>> ListModelRows(Connection& connection,
                                                       const std::string& after, int limit) {
  std::vector<StoredModel> models;
  Query query = connection.Prepare(kListModels, after, std::max(limit, 0));
  while (query.Next()) {
    HOMING_ASSIGN_OR_RETURN(StoredModel model, ReadModelRow(query));
    models.push_back(std::move(model));
  }
  return models;
}

}  // namespace homing::storage
