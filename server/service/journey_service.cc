#include "server/service/journey_service.h"

#include "absl/time/clock.h"
#include "homing/base/status_macros.h"
#include "server/service/archive_streams.h"
#include "server/service/journey_requests.h"
#include "server/service/message_conversion.h"
#include "server/service/record_stream.h"
#include "server/service/route_description.h"

namespace homing::server {

JourneyServiceHandler::JourneyServiceHandler(ServiceCore* core) : ApiService(core) {
  AddUnary(Rpc::kCreateJourney, &JourneyServiceHandler::CreateJourney);
  AddUnary(Rpc::kGetJourney, &JourneyServiceHandler::GetJourney);
  AddUnary(Rpc::kListJourneys, &JourneyServiceHandler::ListJourneys);
  AddUnary(Rpc::kDeleteJourney, &JourneyServiceHandler::DeleteJourney);
  AddUnary(Rpc::kFinishJourney, &JourneyServiceHandler::FinishJourney);
  AddUnary(Rpc::kSetReaders, &JourneyServiceHandler::SetReaders);
  AddUnary(Rpc::kListLandmarks, &JourneyServiceHandler::ListLandmarks);
  AddUnary(Rpc::kDescribeRoute, &JourneyServiceHandler::DescribeRoute);
  AddUnary(Rpc::kAnalyzeAliasing, &JourneyServiceHandler::AnalyzeAliasing);
  AddStream<RecordStream, v1::RecordJourneyResponse>(Rpc::kRecordJourney);
  AddStream<ExportStream, v1::ExportJourneyResponse>(Rpc::kExportJourney);
  AddStream<ImportStream, v1::ImportJourneyResponse>(Rpc::kImportJourney);
}

void JourneyServiceHandler::CreateJourney(const UnaryCall::Ptr& call,
                                          const v1::CreateJourneyRequest* request,
                                          v1::Journey* response) {
  ServeUnary(
      call, request->parent(),
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(
            const storage::JourneyRecord wanted,
            DecodeCreateJourney(*request, &core->models, absl::GetCurrentTimeNanos()));
        HOMING_RETURN_IF_ERROR(core->quota.CheckNew(wanted.name));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord made, core->catalog.Create(wanted));
        *response = EncodeJourneyRecord(made);
        return absl::OkStatus();
      },
      &core()->store_writes);
}

void JourneyServiceHandler::GetJourney(const UnaryCall::Ptr& call,
                                       const v1::GetJourneyRequest* request,
                                       v1::Journey* response) {
  ServeUnary(
      call, request->name(),
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                                core->catalog.Get(name.ToString()));
        *response = EncodeJourneyRecord(record);
        return absl::OkStatus();
      },
      &core()->store_reads);
}

void JourneyServiceHandler::ListJourneys(const UnaryCall::Ptr& call,
                                         const v1::ListJourneysRequest* request,
                                         v1::ListJourneysResponse* response) {
  ServeUnary(
      call, request->parent(),
      [core = core(), request, response](const JourneyFilter& filter) -> absl::Status {
        return ListJourneyPage(*request, &core->catalog, filter, response);
      },
      &core()->store_reads);
}

void JourneyServiceHandler::DeleteJourney(const UnaryCall::Ptr& call,
                                          const v1::DeleteJourneyRequest* request,
                                          v1::DeleteJourneyResponse* /*response*/) {
  ServeUnary(
      call, request->name(),
      [core = core(), request](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        return core->catalog.Delete(name.ToString());
      },
      &core()->store_writes);
}

void JourneyServiceHandler::FinishJourney(const UnaryCall::Ptr& call,
                                          const v1::FinishJourneyRequest* request,
                                          v1::FinishJourneyResponse* response) {
  ServeUnary(
      call, request->name(),
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        HOMING_RETURN_IF_ERROR(CheckWriterId(request->writer_id(), "writer_id"));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                                core->catalog.Finish(name.ToString(), request->writer_id(),
                                                     request->force(), core->options.clock()));
        *response->mutable_journey() = EncodeJourneyRecord(record);
        return absl::OkStatus();
      },
      &core()->store_writes);
}

void JourneyServiceHandler::SetReaders(const UnaryCall::Ptr& call,
                                       const v1::SetReadersRequest* request,
                                       v1::Journey* response) {
  ServeUnary(
      call, request->name(),
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request->name(), "name"));
        HOMING_ASSIGN_OR_RETURN(const auto readers, DecodeReaders(request->readers(), "readers"));
        HOMING_ASSIGN_OR_RETURN(const storage::JourneyRecord record,
                                core->catalog.SetReaders(name.ToString(), readers));
        *response = EncodeJourneyRecord(record);
        return absl::OkStatus();
      },
      &core()->store_writes);
}

void JourneyServiceHandler::ListLandmarks(const UnaryCall::Ptr& call,
                                          const v1::ListLandmarksRequest* request,
                                          v1::ListLandmarksResponse* response) {
  ServeUnary(
      call, request->parent(),
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return ListLandmarkPage(*request, &core->catalog, response);
      },
      &core()->store_reads);
}

void JourneyServiceHandler::AnalyzeAliasing(const UnaryCall::Ptr& call,
                                            const v1::AnalyzeAliasingRequest* request,
                                            v1::AnalyzeAliasingResponse* response) {
  ServeUnary(
      call, request->name(),
      [core = core(), call, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return DescribeAliasing(*request, &core->catalog, call->cancellation(), response);
      },
      &core()->long_work);
}

void JourneyServiceHandler::DescribeRoute(const UnaryCall::Ptr& call,
                                          const v1::DescribeRouteRequest* request,
                                          v1::DescribeRouteResponse* response) {
  ServeUnary(
      call, request->name(),
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return FillRouteDescription(*request, &core->catalog, response);
      },
      &core()->store_reads);
}

}  // namespace homing::server
