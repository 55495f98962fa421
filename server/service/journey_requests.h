// Requests of JourneyService that hold more than a name.
#ifndef SERVER_SERVICE_JOURNEY_REQUESTS_H_
#define SERVER_SERVICE_JOURNEY_REQUESTS_H_

#include <cstdint>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/v1/journey_service.pb.h"
#include "server/catalog/journey_catalog.h"
#include "server/catalog/model_catalog.h"
#include "storage/journey_store.h"

namespace homing::server {

// Robots' names and "*". INVALID_ARGUMENT naming `field`.
absl::StatusOr<std::vector<std::string>> DecodeReaders(
    const google::protobuf::RepeatedPtrField<std::string>& readers, const std::string& field);

// `now_ns` is the server's clock. INVALID_ARGUMENT; NOT_FOUND (deviation model).
absl::StatusOr<storage::JourneyRecord> DecodeCreateJourney(const v1::CreateJourneyRequest& request,
                                                           ModelCatalog* models,
                                                           std::int64_t now_ns);

// INVALID_ARGUMENT.
absl::Status ListJourneyPage(const v1::ListJourneysRequest& request, JourneyCatalog* catalog,
                             const JourneyFilter& filter, v1::ListJourneysResponse* response);

// INVALID_ARGUMENT, NOT_FOUND.
absl::Status DescribeAliasing(const v1::AnalyzeAliasingRequest& request, JourneyCatalog* catalog,
                              const Cancellation* cancellation,
                              v1::AnalyzeAliasingResponse* response);

absl::Status ListLandmarkPage(const v1::ListLandmarksRequest& request, JourneyCatalog* catalog,
                              v1::ListLandmarksResponse* response);

}  // namespace homing::server

#endif  // SERVER_SERVICE_JOURNEY_REQUESTS_H_
