#include "server/service/homing_service.h"

#include "homing/base/status_macros.h"
#include "server/rpc/unary_call.h"
#include "server/service/localize_stream.h"
#include "server/service/message_conversion.h"

namespace homing::server {

namespace {

// A robot sees at most two landmarks a camera. More take as much longer, on a long map for many
// seconds: robots do not wait for them.
constexpr int kUsualFingerprints = 8;

bool IsLong(const v1::MatchLandmarksRequest& request) {
  return request.left().fingerprints().fingerprints_size() +
             request.right().fingerprints().fingerprints_size() >
         kUsualFingerprints;
}

}  // namespace

grpc::ServerUnaryReactor* HomingServiceHandler::MatchLandmarks(
    grpc::CallbackServerContext* context, const v1::MatchLandmarksRequest* request,
    v1::MatchLandmarksResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kMatchLandmarks, request->journey(), response,
      [core = core_, context, request, response](const JourneyFilter& filter) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(LandmarkQuery query,
                                DecodeLandmarkQuery(*request, core->options.wire));
        query.filter = filter;
        const UnaryCancellation cancellation(context);
        DecodeLimits limits = core->options.decode;
        limits.cancellation = &cancellation;
        HOMING_ASSIGN_OR_RETURN(const LandmarkQueryResult result,
                                server::MatchLandmarks(&core->catalog, query, limits));
        *response = EncodeQueryResult(result);
        return absl::OkStatus();
      },
      IsLong(*request) ? &core_->long_work : &core_->pool);
}

grpc::ServerBidiReactor<v1::LocalizeRequest, v1::LocalizeResponse>* HomingServiceHandler::Localize(
    grpc::CallbackServerContext* context) {
  const auto stream = std::make_shared<LocalizeStream>(core_, context);
  stream->Open();
  return stream.get();
}

}  // namespace homing::server
