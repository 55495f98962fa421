#include "server/service/journey_service.h"

#include "absl/time/clock.h"
#include "homing/base/status_macros.h"
#include "server/rpc/unary_call.h"
#include "server/service/archive_streams.h"
#include "server/service/journey_requests.h"
#include "server/service/message_conversion.h"
#include "server/service/record_stream.h"
#include "server/service/route_description.h"

namespace homing::server {

grpc::ServerUnaryReactor* JourneyServiceHandler::CreateJourney(
    grpc::CallbackServerContext* context, const v1::CreateJourneyRequest* request,
    v1::Journey* response) {
  return ServeUnary(
      core_, context, Rpc::kCreateJourney, request->parent(), response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(
            const storage::JourneyRecord wanted,
            DecodeCreateJourney(*request, &core->models, absl::GetCurrentTimeNanos()));
        HOMING_RETURN_IF_ERROR(core->quota.CheckNew(wanted.name));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord made, core->catalog.Create(wanted));
        *response = EncodeJourneyRecord(made);
        return absl::OkStatus();
      },
      &core_->store_writes);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::GetJourney(grpc::CallbackServerContext* context,
                                                            const v1::GetJourneyRequest* request,
                                                            v1::Journey* response) {
  return ServeUnary(
      core_, context, Rpc::kGetJourney, request->name(), response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                                core->catalog.Get(name.ToString()));
        *response = EncodeJourneyRecord(record);
        return absl::OkStatus();
      },
      &core_->store_reads);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::ListJourneys(
    grpc::CallbackServerContext* context, const v1::ListJourneysRequest* request,
    v1::ListJourneysResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kListJourneys, request->parent(), response,
      [core = core_, request, response](const JourneyFilter& filter) -> absl::Status {
        return ListJourneyPage(*request, &core->catalog, filter, response);
      },
      &core_->store_reads);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::DeleteJourney(
    grpc::CallbackServerContext* context, const v1::DeleteJourneyRequest* request,
    v1::DeleteJourneyResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kDeleteJourney, request->name(), response,
      [core = core_, request](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        return core->catalog.Delete(name.ToString());
      },
      &core_->store_writes);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::FinishJourney(
    grpc::CallbackServerContext* context, const v1::FinishJourneyRequest* request,
    v1::FinishJourneyResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kFinishJourney, request->name(), response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        HOMING_RETURN_IF_ERROR(CheckWriterId(request->writer_id(), "writer_id"));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                                core->catalog.Finish(name.ToString(), request->writer_id(),
                                                     request->force(), core->options.clock()));
        *response->mutable_journey() = EncodeJourneyRecord(record);
        return absl::OkStatus();
      },
      &core_->store_writes);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::SetReaders(grpc::CallbackServerContext* context,
                                                            const v1::SetReadersRequest* request,
                                                            v1::Journey* response) {
  return ServeUnary(
      core_, context, Rpc::kSetReaders, request->name(), response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        HOMING_ASSIGN_OR_RETURN(const auto readers, DecodeReaders(request->readers(), "readers"));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                                core->catalog.SetReaders(name.ToString(), readers));
        *response = EncodeJourneyRecord(record);
        return absl::OkStatus();
      },
      &core_->store_writes);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::ListLandmarks(
    grpc::CallbackServerContext* context, const v1::ListLandmarksRequest* request,
    v1::ListLandmarksResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kListLandmarks, request->parent(), response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return ListLandmarkPage(*request, &core->catalog, response);
      },
      &core_->store_reads);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::AnalyzeAliasing(
    grpc::CallbackServerContext* context, const v1::AnalyzeAliasingRequest* request,
    v1::AnalyzeAliasingResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kAnalyzeAliasing, request->name(), response,
      [core = core_, context, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        const UnaryCancellation cancellation(context);
        return DescribeAliasing(*request, &core->catalog, &cancellation, response);
      },
      &core_->long_work);
}

grpc::ServerUnaryReactor* JourneyServiceHandler::DescribeRoute(
    grpc::CallbackServerContext* context, const v1::DescribeRouteRequest* request,
    v1::DescribeRouteResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kDescribeRoute, request->name(), response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return FillRouteDescription(*request, &core->catalog, response);
      },
      &core_->store_reads);
}

grpc::ServerBidiReactor<v1::RecordJourneyRequest, v1::RecordJourneyResponse>*
JourneyServiceHandler::RecordJourney(grpc::CallbackServerContext* context) {
  const auto stream = std::make_shared<RecordStream>(core_, context);
  stream->Open();
  return stream.get();
}

grpc::ServerWriteReactor<v1::ExportJourneyResponse>* JourneyServiceHandler::ExportJourney(
    grpc::CallbackServerContext* context, const v1::ExportJourneyRequest* request) {
  const auto stream = std::make_shared<ExportStream>(core_, context, request->name());
  stream->Open();
  return stream.get();
}

grpc::ServerReadReactor<v1::ImportJourneyRequest>* JourneyServiceHandler::ImportJourney(
    grpc::CallbackServerContext* context, v1::ImportJourneyResponse* response) {
  const auto stream = std::make_shared<ImportStream>(core_, context, response);
  stream->Open();
  return stream.get();
}

}  // namespace homing::server
