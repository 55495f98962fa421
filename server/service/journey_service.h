// JourneyService: each RPC decodes, calls the session layer once, and encodes.
#ifndef SERVER_SERVICE_JOURNEY_SERVICE_H_
#define SERVER_SERVICE_JOURNEY_SERVICE_H_

#include "homing/v1/journey_service.grpc.pb.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Thread-safe: gRPC calls the methods on its own threads.
class JourneyServiceHandler final : public v1::JourneyService::CallbackService {
 public:
  // `core` must outlive the service.
  explicit JourneyServiceHandler(ServiceCore* core) : core_(core) {}

  grpc::ServerUnaryReactor* CreateJourney(grpc::CallbackServerContext* context,
                                          const v1::CreateJourneyRequest* request,
                                          v1::Journey* response) override;
  grpc::ServerUnaryReactor* GetJourney(grpc::CallbackServerContext* context,
                                       const v1::GetJourneyRequest* request,
                                       v1::Journey* response) override;
  grpc::ServerUnaryReactor* ListJourneys(grpc::CallbackServerContext* context,
                                         const v1::ListJourneysRequest* request,
                                         v1::ListJourneysResponse* response) override;
  grpc::ServerUnaryReactor* DeleteJourney(grpc::CallbackServerContext* context,
                                          const v1::DeleteJourneyRequest* request,
                                          v1::DeleteJourneyResponse* response) override;
  grpc::ServerUnaryReactor* FinishJourney(grpc::CallbackServerContext* context,
                                          const v1::FinishJourneyRequest* request,
                                          v1::FinishJourneyResponse* response) override;
  grpc::ServerUnaryReactor* SetReaders(grpc::CallbackServerContext* context,
                                       const v1::SetReadersRequest* request,
                                       v1::Journey* response) override;
  grpc::ServerUnaryReactor* ListLandmarks(grpc::CallbackServerContext* context,
                                          const v1::ListLandmarksRequest* request,
                                          v1::ListLandmarksResponse* response) override;
  grpc::ServerUnaryReactor* DescribeRoute(grpc::CallbackServerContext* context,
                                          const v1::DescribeRouteRequest* request,
                                          v1::DescribeRouteResponse* response) override;
  grpc::ServerUnaryReactor* AnalyzeAliasing(grpc::CallbackServerContext* context,
                                            const v1::AnalyzeAliasingRequest* request,
                                            v1::AnalyzeAliasingResponse* response) override;
  grpc::ServerBidiReactor<v1::RecordJourneyRequest, v1::RecordJourneyResponse>* RecordJourney(
      grpc::CallbackServerContext* context) override;
  grpc::ServerWriteReactor<v1::ExportJourneyResponse>* ExportJourney(
      grpc::CallbackServerContext* context, const v1::ExportJourneyRequest* request) override;
  grpc::ServerReadReactor<v1::ImportJourneyRequest>* ImportJourney(
      grpc::CallbackServerContext* context, v1::ImportJourneyResponse* response) override;

 private:
  ServiceCore* const core_;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_JOURNEY_SERVICE_H_
