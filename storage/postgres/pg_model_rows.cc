#include "storage/postgres/pg_model_rows.h"

#include <algorithm>

#include "homing/base/status_macros.h"
#include "storage/row_columns.h"
#include "storage/store_errors.h"

namespace homing::storage::postgres {
namespace {

constexpr char kInsertModel[] = "INSERT INTO deviation_models (" HOMING_MODEL_COLUMNS
                                ") VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9)"
                                " ON CONFLICT DO NOTHING";
constexpr char kFindModel[] =
    "SELECT " HOMING_MODEL_COLUMNS " FROM deviation_models WHERE name = $1";
constexpr char kListModels[] =
    "SELECT " HOMING_MODEL_COLUMNS " FROM deviation_models WHERE name > $1 ORDER BY name LIMIT $2";

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
  const PgRow row{rows, 0};
  HOMING_ASSIGN_OR_RETURN(StoredModel model, ReadModel(row));
  HOMING_RETURN_IF_ERROR(CheckModel(model));
  return model;
}

absl::StatusOr<std::vector<StoredModel>> ListModelRows(PgConnection& connection,
                                                       const std::string& after, int limit,
                                                       Deadline deadline) {
  PgArguments arguments;
  arguments.Text(after).Integer(std::max(limit, 0));
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection.Run(kListModels, arguments, deadline));
  std::vector<StoredModel> models;
  for (int row = 0; row < rows.size(); ++row) {
    const PgRow at{rows, row};
    HOMING_ASSIGN_OR_RETURN(models.emplace_back(), ReadModel(at));
  }
  return models;
}

}  // namespace homing::storage::postgres
