// JourneyService: each RPC decodes, calls the session layer once, and encodes.
#ifndef SERVER_SERVICE_JOURNEY_SERVICE_H_
#define SERVER_SERVICE_JOURNEY_SERVICE_H_

#include "homing/v1/journey_service.pb.h"
#include "server/rpc/api_service.h"

namespace homing::server {

class JourneyServiceHandler final : public ApiService {
 public:
  // `core` must outlive the service.
  explicit JourneyServiceHandler(ServiceCore* core);

 private:
  void CreateJourney(const UnaryCall::Ptr& call, const v1::CreateJourneyRequest* request,
                     v1::Journey* response);
  void GetJourney(const UnaryCall::Ptr& call, const v1::GetJourneyRequest* request,
                  v1::Journey* response);
  void ListJourneys(const UnaryCall::Ptr& call, const v1::ListJourneysRequest* request,
                    v1::ListJourneysResponse* response);
  void DeleteJourney(const UnaryCall::Ptr& call, const v1::DeleteJourneyRequest* request,
                     v1::DeleteJourneyResponse* response);
  void FinishJourney(const UnaryCall::Ptr& call, const v1::FinishJourneyRequest* request,
                     v1::FinishJourneyResponse* response);
  void SetReaders(const UnaryCall::Ptr& call, const v1::SetReadersRequest* request,
                  v1::Journey* response);
  void ListLandmarks(const UnaryCall::Ptr& call, const v1::ListLandmarksRequest* request,
                     v1::ListLandmarksResponse* response);
  void DescribeRoute(const UnaryCall::Ptr& call, const v1::DescribeRouteRequest* request,
                     v1::DescribeRouteResponse* response);
  void AnalyzeAliasing(const UnaryCall::Ptr& call, const v1::AnalyzeAliasingRequest* request,
                       v1::AnalyzeAliasingResponse* response);
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_JOURNEY_SERVICE_H_
