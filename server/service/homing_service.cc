#include "server/service/homing_service.h"

#include <memory>

#include "homing/base/status_macros.h"
#include "server/service/large_images.h"
#include "server/service/localize_stream.h"
#include "server/service/message_conversion.h"

namespace homing::server {

namespace {

// A robot sees at most two landmarks a camera. The time of a query grows with their number, on a
// long map to many seconds: queries of more run beside the robots' workers.
constexpr int kUsualFingerprints = 8;

bool IsLong(const v1::MatchLandmarksRequest& request) {
  return request.left().fingerprints().fingerprints_size() +
             request.right().fingerprints().fingerprints_size() >
         kUsualFingerprints;
}

// Where a query is compared with its journeys.
WorkerPool* PoolOf(const v1::MatchLandmarksRequest& request, ServiceCore* core) {
  if (IsLong(request)) return &core->long_work;
  return HasLargeImage(request) ? &core->large_images : &core->pool;
}

// One query: its journeys are loaded in one pool, and compared in another.
class Search {
 public:
  Search(ServiceCore* core, const Cancellation* cancellation)
      : core_(core), limits_(core->options.decode) {
    limits_.cancellation = cancellation;
  }

  absl::Status Load(const v1::MatchLandmarksRequest& request, const JourneyFilter& filter) {
    HOMING_ASSIGN_OR_RETURN(query_, DecodeLandmarkQuery(request, core_->options.wire));
    query_.filter = filter;
    HOMING_ASSIGN_OR_RETURN(journeys_, LoadQueryJourneys(&core_->catalog, query_, limits_));
    return absl::OkStatus();
  }

  absl::Status Match(v1::MatchLandmarksResponse* response) const {
    HOMING_ASSIGN_OR_RETURN(const LandmarkQueryResult result,
                            server::MatchLandmarks(&core_->catalog, query_, journeys_, limits_));
    *response = EncodeQueryResult(result);
    return absl::OkStatus();
  }

 private:
  ServiceCore* const core_;
  DecodeLimits limits_;
  LandmarkQuery query_;
  QueryJourneys journeys_;
};

}  // namespace

HomingServiceHandler::HomingServiceHandler(ServiceCore* core) : ApiService(core) {
  AddUnary(Rpc::kMatchLandmarks, &HomingServiceHandler::MatchLandmarks);
  AddStream<LocalizeStream, v1::LocalizeResponse>(Rpc::kLocalize);
}

void HomingServiceHandler::MatchLandmarks(const UnaryCall::Ptr& call,
                                          const v1::MatchLandmarksRequest* request,
                                          v1::MatchLandmarksResponse* response) {
  const auto search = std::make_shared<Search>(core(), call->cancellation());
  ServeUnary(
      call, request->journey(),
      [search, request](const JourneyFilter& filter) { return search->Load(*request, filter); },
      &core()->store_reads,
      {[search, response] { return search->Match(response); }, PoolOf(*request, core())});
}

}  // namespace homing::server
