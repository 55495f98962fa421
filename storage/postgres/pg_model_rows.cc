#include "storage/postgres/pg_model_rows.h"

#include <algorithm>

#include "homing/base/status_macros.h"
#include "storage/settings_json.h"
#include "storage/store_errors.h"

namespace homing::storage::postgres {
namespace {

#define HOMING_PG_MODEL_COLUMNS \
  "name, mu, sigma, observations, ks_distance, width, height, training, create_time_ns"

constexpr char kInsertModel[] = "INSERT INTO deviation_models (" HOMING_PG_MODEL_COLUMNS
                                ") VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9)"
                                " ON CONFLICT DO NOTHING";
constexpr char kFindModel[] =
    "SELECT " HOMING_PG_MODEL_COLUMNS " FROM deviation_models WHERE name = $1";
constexpr char kListModels[] = "SELECT " HOMING_PG_MODEL_COLUMNS
                               " FROM deviation_models WHERE name > $1 ORDER BY name LIMIT $2";

absl::StatusOr<StoredModel> ReadModelRow(const PgRows& rows, int row) {
  StoredModel stored;
  stored.name = rows.Text(row, 0);
  stored.model.mu = rows.Real(row, 1);
  stored.model.sigma = rows.Real(row, 2);
  stored.model.observations = static_cast<int>(rows.Integer(row, 3));
  stored.model.ks_distance = rows.Real(row, 4);
  stored.model.width = static_cast<int>(rows.Integer(row, 5));
  stored.model.height = static_cast<int>(rows.Integer(row, 6));
  HOMING_ASSIGN_OR_RETURN(stored.training, TrainingOptionsFromJson(rows.Text(row, 7)));
  stored.create_time_ns = rows.Integer(row, 8);
  return stored;
}

}  // namespace

absl::Status InsertModel(PgConnection& connection, const StoredModel& model, Deadline deadline) {
  PgArguments arguments;
  arguments.Text(model.name).Real(model.model.mu).Real(model.model.sigma);
  arguments.Integer(model.model.observations).Real(model.model.ks_distance);
  arguments.Integer(model.model.width).Integer(model.model.height);
  arguments.Text(ToJson(model.training)).Integer(model.create_time_ns);
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection.Run(kInsertModel, arguments, deadline));
  if (rows.changed() > 0) return absl::OkStatus();
  return ModelExists(model.name);
}

absl::StatusOr<StoredModel> FindModel(PgConnection& connection, const std::string& name,
                                      Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(const PgRows rows,
                          connection.Run(kFindModel, PgArguments().Text(name), deadline));
  if (rows.size() == 0) return ModelNotFound(name);
  return ReadModelRow(rows, 0);
}

absl::StatusOr<std::vector<StoredModel>> ListModelRows(PgConnection& connection,
                                                       const std::string& after, int limit,
                                                       Deadline deadline) {
  PgArguments arguments;
  arguments.Text(after).Integer(std::max(limit, 0));
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection.Run(kListModels, arguments, deadline));
  std::vector<StoredModel> models;
  for (int row = 0; row < rows.size(); ++row) {
    HOMING_ASSIGN_OR_RETURN(models.emplace_back(), ReadModelRow(rows, row));
  }
  return models;
}

}  // namespace homing::storage::postgres
