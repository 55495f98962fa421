#include "server/catalog/model_catalog.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "server/base/resource_name.h"

namespace homing::server {
namespace {

storage::StoredModel BuiltIn() {
  storage::StoredModel model;
  model.name = kDefaultModelName;
  return model;
}

}  // namespace

absl::StatusOr<TrainedModel> ModelCatalog::Train(const std::string& model_id,
                                                 const TrainingOptions& options,
                                                 std::int64_t now_ns) {
  HOMING_RETURN_IF_ERROR(CheckNewId(model_id, "model_id"));
  TrainedModel trained;
  trained.stored.name = absl::StrCat("deviationModels/", model_id);
  trained.stored.training = options;
  trained.stored.create_time_ns = now_ns;
  if (trained.stored.name == kDefaultModelName) {
    return FieldError("model_id", "\"default\" is built in; choose another id");
  }
  absl::StatusOr<TrainingResult> result = TrainDeviationModel(options);
  if (!result.ok()) return Within("settings", result.status());
  trained.stored.model = result->model;
  trained.deviations_px = std::move(result->deviations_px);
  const absl::Status status = store_->CreateModel(trained.stored);
  if (absl::IsAlreadyExists(status)) {
    HOMING_ASSIGN_OR_RETURN(storage::StoredModel present, store_->GetModel(trained.stored.name));
    if (present.model != trained.stored.model) {
      return absl::AlreadyExistsError(
          absl::StrCat("model_id: \"", model_id, "\" exists with other settings"));
    }
    trained.stored = std::move(present);
    return trained;
  }
  HOMING_RETURN_IF_ERROR(status);
  return trained;
}

absl::StatusOr<storage::StoredModel> ModelCatalog::Get(const std::string& name) {
  HOMING_RETURN_IF_ERROR(ParseModelName(name, "name").status());
  if (name == kDefaultModelName) {
    return BuiltIn();
  }
  return store_->GetModel(name);
}

absl::StatusOr<std::vector<storage::StoredModel>> ModelCatalog::List(const std::string& after,
                                                                     int limit) {
  HOMING_ASSIGN_OR_RETURN(std::vector<storage::StoredModel> models,
                          store_->ListModels(after, limit));
  if (after < kDefaultModelName) {
    const auto place = std::find_if(models.begin(), models.end(), [](const auto& model) {
      return model.name > kDefaultModelName;
    });
    models.insert(place, BuiltIn());
    models.resize(std::min(models.size(), static_cast<std::size_t>(limit)));
  }
  return models;
}

}  // namespace homing::server
