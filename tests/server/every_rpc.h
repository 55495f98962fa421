// Each method of the API, called over a real channel by someone.
#ifndef TESTS_SERVER_EVERY_RPC_H_
#define TESTS_SERVER_EVERY_RPC_H_

#include <grpcpp/grpcpp.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "homing/v1/deviation_model_service.grpc.pb.h"
#include "homing/v1/fleet_service.grpc.pb.h"
#include "homing/v1/homing_service.grpc.pb.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "homing/v1/store_service.grpc.pb.h"
#include "server/access/rpc.h"

namespace homing::server {

class EveryRpc {
 public:
  // `token` empty: none is sent.
  EveryRpc(const std::shared_ptr<grpc::Channel>& channel, std::string token);

  // Calls it about `journey` ("robots/R/journeys/J", which exists and has no steps). A caller with
  // the right gets ExpectedCode.
  grpc::Status Call(Rpc rpc, const std::string& journey);
  // The code for a caller with the right: OK, or an error from after the check of rights.
  static grpc::StatusCode ExpectedCode(Rpc rpc);

  // Appends the copy of the store to `file`, if any.
  grpc::Status BackUp(std::string* file = nullptr);
  // The names that ListJourneys of `parent` returns.
  std::vector<std::string> List(const std::string& parent);
  grpc::Status Create(const std::string& journey, const std::vector<std::string>& readers);
  // A stream that names `journey` (or a pattern), sends nothing more and reads to the end.
  grpc::Status Localize(const std::string& journey);
  grpc::Status Record(const std::string& journey);
  grpc::Status Match(const std::string& journey);
  // The journeys that both queries find in `pattern` for the view `seen`, each once.
  std::set<std::string> Recognise(const std::string& pattern, const v1::Observation& seen);

 private:
  grpc::Status CallJourneys(Rpc rpc, const std::string& journey);
  grpc::Status CallModels(Rpc rpc);
  grpc::Status CallFleet(Rpc rpc, const std::string& robot);
  grpc::Status Export(const std::string& journey);
  grpc::Status Import(const std::string& journey);
  std::unique_ptr<grpc::ClientContext> Context() const;

  const std::string token_;
  std::unique_ptr<v1::JourneyService::Stub> journeys_;
  std::unique_ptr<v1::HomingService::Stub> homing_;
  std::unique_ptr<v1::DeviationModelService::Stub> models_;
  std::unique_ptr<v1::StoreService::Stub> store_;
  std::unique_ptr<v1::FleetService::Stub> fleet_;
};

}  // namespace homing::server

#endif  // TESTS_SERVER_EVERY_RPC_H_
