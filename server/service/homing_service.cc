#include "server/service/homing_service.h"

#include <memory>

#include "homing/base/status_macros.h"
#include "server/rpc/unary_call.h"
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

// One query: its journeys are loaded in one pool, and compared in another.
class Search {
 public:
  Search(ServiceCore* core, const grpc::CallbackServerContext* context)
      : core_(core), cancellation_(context), limits_(core->options.decode) {
    limits_.cancellation = &cancellation_;
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
  const UnaryCancellation cancellation_;
  DecodeLimits limits_;
  LandmarkQuery query_;
  QueryJourneys journeys_;
};

}  // namespace

grpc::ServerUnaryReactor* HomingServiceHandler::MatchLandmarks(
    grpc::CallbackServerContext* context, const v1::MatchLandmarksRequest* request,
    v1::MatchLandmarksResponse* response) {
  const auto search = std::make_shared<Search>(core_, context);
  return ServeUnary(
      core_, context, Rpc::kMatchLandmarks, request->journey(), response,
      [search, request](const JourneyFilter& filter) { return search->Load(*request, filter); },
      &core_->store_reads,
      {[search, response] { return search->Match(response); },
       IsLong(*request) ? &core_->long_work : &core_->pool});
}

grpc::ServerBidiReactor<v1::LocalizeRequest, v1::LocalizeResponse>* HomingServiceHandler::Localize(
    grpc::CallbackServerContext* context) {
  const auto stream = std::make_shared<LocalizeStream>(core_, context);
  stream->Open();
  return stream.get();
}

}  // namespace homing::server
