// Manages journeys: create, list, finish, delete, export, import.
#ifndef CLIENT_JOURNEY_CLIENT_H_
#define CLIENT_JOURNEY_CLIENT_H_

#include <functional>
#include <istream>
#include <memory>
#include <ostream>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "homing/v1/journey_service.grpc.pb.h"

namespace homing::client {

// The two ids in "robots/R/journeys/J".
struct JourneyName {
  // "robots/R".
  std::string parent;
  std::string journey_id;
};

// INVALID_ARGUMENT: not of that form. The server checks the ids.
absl::StatusOr<JourneyName> ParseJourneyName(const std::string& name);

// Each call is retried while IsRetriable. Not thread-safe. Errors of the RPC of the same name.
class JourneyClient {
 public:
  // REQUIRES: `connection` outlives the client.
  explicit JourneyClient(const Connection* connection, std::stop_token stop = {});

  absl::StatusOr<v1::Journey> Create(const v1::CreateJourneyRequest& request);
  absl::StatusOr<v1::Journey> Get(const std::string& name);
  absl::Status Delete(const std::string& name);
  absl::StatusOr<v1::Journey> Finish(const std::string& name, const std::string& writer_id,
                                     bool force = false);
  absl::StatusOr<v1::Journey> SetReaders(const std::string& name,
                                         const std::vector<std::string>& readers);
  // All pages. `parent` is "robots/R" or "robots/-".
  absl::Status List(const std::string& parent,
                    const std::function<absl::Status(const v1::Journey&)>& each);
  absl::Status ListLandmarks(const std::string& journey, bool include_fingerprints,
                             const std::function<absl::Status(const v1::Landmark&)>& each);
  // One column for the whole journey: where the cameras look, and how large the map is.
  absl::StatusOr<v1::DescribeRouteResponse> DescribeRoute(const std::string& journey);
  absl::StatusOr<v1::AnalyzeAliasingResponse> AnalyzeAliasing(const std::string& journey,
                                                              int tolerance_steps);
  // Not retried: a part of the file may already be written.
  absl::Status Export(const std::string& name, std::ostream& file);
  absl::StatusOr<v1::Journey> Import(const std::string& name, std::istream& file);

 private:
  const Connection* connection_;
  std::stop_token stop_;
  std::unique_ptr<v1::JourneyService::StubInterface> stub_;
};

}  // namespace homing::client

#endif  // CLIENT_JOURNEY_CLIENT_H_
