// Trains and lists deviation models.
#ifndef CLIENT_MODEL_CLIENT_H_
#define CLIENT_MODEL_CLIENT_H_

#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "homing/v1/deviation_model_service.grpc.pb.h"

namespace homing::client {

// Each call is retried while IsRetriable. Errors of the RPC of the same name. Not thread-safe.
class ModelClient {
 public:
  // REQUIRES: `connection` outlives the client.
  explicit ModelClient(const Connection* connection, std::stop_token stop = {});

  absl::StatusOr<v1::TrainDeviationModelResponse> Train(
      const v1::TrainDeviationModelRequest& request);
  absl::StatusOr<v1::DeviationModel> Get(const std::string& name);

 private:
  const Connection* connection_;
  std::stop_token stop_;
  std::unique_ptr<v1::DeviationModelService::StubInterface> stub_;
};

}  // namespace homing::client

#endif  // CLIENT_MODEL_CLIENT_H_
