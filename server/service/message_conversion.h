// Converts the services' messages to and from the session layer's types. Conversions that client
// and server share are in proto/wire.
#ifndef SERVER_SERVICE_MESSAGE_CONVERSION_H_
#define SERVER_SERVICE_MESSAGE_CONVERSION_H_

#include <string>

#include "absl/status/statusor.h"
#include "homing/v1/deviation_model_service.pb.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"
#include "proto/wire/observation_conversion.h"
#include "server/session/landmark_query.h"
#include "server/session/localization_session.h"
#include "server/session/recording_session.h"
#include "storage/journey_store.h"

namespace homing::server {

v1::Journey EncodeJourneyRecord(const storage::JourneyRecord& record);
// These two fill in an empty answer.
void EncodeRecordingAnswer(const RecordingAnswer& answer, v1::RecordJourneyResponse* message);
void EncodeLocalization(const Localization& localization, const LocalizationSession& session,
                        v1::LocalizeResponse* message);
v1::MatchLandmarksResponse EncodeQueryResult(const LandmarkQueryResult& result);
v1::DeviationModel EncodeModel(const storage::StoredModel& model);

// INVALID_ARGUMENT naming field, value and limit. Unset fields have their defaults.
absl::StatusOr<LocalizationQuery> DecodeLocalizationQuery(const v1::LocalizeConfig& config);
// Frames point into `request`, which must outlive the result.
absl::StatusOr<LandmarkQuery> DecodeLandmarkQuery(const v1::MatchLandmarksRequest& request,
                                                  const wire::WireLimits& limits);
TrainingOptions DecodeTraining(const v1::TrainingSettings& settings);

}  // namespace homing::server

#endif  // SERVER_SERVICE_MESSAGE_CONVERSION_H_
