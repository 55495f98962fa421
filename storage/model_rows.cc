#include "storage/model_rows.h"

#include <algorithm>

#include "homing/base/status_macros.h"
#include "storage/row_columns.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

constexpr char kInsertModel[] = "INSERT INTO deviation_models (" HOMING_MODEL_COLUMNS
                                ") VALUES (?,?,?,?,?,?,?,?,?) ON CONFLICT DO NOTHING";
constexpr char kFindModel[] =
    "SELECT " HOMING_MODEL_COLUMNS " FROM deviation_models WHERE name = ?";
constexpr char kListModels[] =
    "SELECT " HOMING_MODEL_COLUMNS " FROM deviation_models WHERE name > ? ORDER BY name LIMIT ?";

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
  HOMING_ASSIGN_OR_RETURN(StoredModel model, ReadModel(query));
  HOMING_RETURN_IF_ERROR(CheckModel(model));
  return model;
}

absl::StatusOr<std::vector<StoredModel>> ListModelRows(Connection& connection,
                                                       const std::string& after, int limit) {
  std::vector<StoredModel> models;
  Query query = connection.Prepare(kListModels, after, std::max(limit, 0));
  while (query.Next()) {
    HOMING_ASSIGN_OR_RETURN(models.emplace_back(), ReadModel(query));
  }
  return models;
}

}  // namespace homing::storage
