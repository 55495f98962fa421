#include "tests/server/every_rpc.h"

#include <utility>

namespace homing::server {
namespace {

std::string ParentOf(const std::string& journey) {
  return journey.substr(0, journey.find("/journeys/"));
}

std::string IdOf(const std::string& journey) { return journey.substr(journey.rfind('/') + 1); }

template <typename Request>
Request Named(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

}  // namespace

EveryRpc::EveryRpc(const std::shared_ptr<grpc::Channel>& channel, std::string token)
    : token_(std::move(token)),
      journeys_(v1::JourneyService::NewStub(channel)),
      homing_(v1::HomingService::NewStub(channel)),
      models_(v1::DeviationModelService::NewStub(channel)),
      store_(v1::StoreService::NewStub(channel)),
      fleet_(v1::FleetService::NewStub(channel)) {}

std::unique_ptr<grpc::ClientContext> EveryRpc::Context() const {
  auto context = std::make_unique<grpc::ClientContext>();
  if (!token_.empty()) {
    context->AddMetadata("authorization", "Bearer " + token_);
  }
  return context;
}

grpc::StatusCode EveryRpc::ExpectedCode(Rpc rpc) {
  switch (rpc) {
    case Rpc::kCreateJourney:
      return grpc::StatusCode::ALREADY_EXISTS;
    case Rpc::kAnalyzeAliasing:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case Rpc::kImportJourney:
    case Rpc::kTrainDeviationModel:
      return grpc::StatusCode::INVALID_ARGUMENT;
    default:
      return grpc::StatusCode::OK;
  }
}

grpc::Status EveryRpc::Create(const std::string& journey, const std::vector<std::string>& readers) {
  v1::CreateJourneyRequest request;
  request.set_parent(ParentOf(journey));
  request.set_journey_id(IdOf(journey));
  for (const std::string& reader : readers) {
    request.mutable_journey()->add_readers(reader);
  }
  v1::Journey response;
  return journeys_->CreateJourney(Context().get(), request, &response);
}

std::vector<std::string> EveryRpc::List(const std::string& parent) {
  v1::ListJourneysRequest request;
  request.set_parent(parent);
  v1::ListJourneysResponse response;
  journeys_->ListJourneys(Context().get(), request, &response);
  std::vector<std::string> names;
  for (const v1::Journey& journey : response.journeys()) {
    names.push_back(journey.name());
  }
  return names;
}

grpc::Status EveryRpc::Record(const std::string& journey) {
  const auto context = Context();
  const auto stream = journeys_->RecordJourney(context.get());
  v1::RecordJourneyRequest request;
  request.mutable_config()->set_journey(journey);
  request.mutable_config()->set_writer_id("writer");
  stream->Write(request);
  stream->WritesDone();
  v1::RecordJourneyResponse response;
  while (stream->Read(&response)) {
  }
  return stream->Finish();
}

grpc::Status EveryRpc::Localize(const std::string& journey) {
  const auto context = Context();
  const auto stream = homing_->Localize(context.get());
  v1::LocalizeRequest request;
  request.mutable_config()->set_journey(journey);
  stream->Write(request);
  stream->WritesDone();
  v1::LocalizeResponse response;
  while (stream->Read(&response)) {
  }
  return stream->Finish();
}

grpc::Status EveryRpc::Match(const std::string& journey) {
  v1::MatchLandmarksRequest request;
  request.set_journey(journey);
  auto* fingerprint = request.mutable_left()->mutable_fingerprints()->add_fingerprints();
  fingerprint->set_x(1);
  fingerprint->set_y(1);
  fingerprint->set_count(1);
  v1::MatchLandmarksResponse response;
  return homing_->MatchLandmarks(Context().get(), request, &response);
}

std::set<std::string> EveryRpc::Recognise(const std::string& pattern, const v1::Observation& seen) {
  std::set<std::string> journeys;
  v1::MatchLandmarksRequest request;
  request.set_journey(pattern);
  request.set_travel(v1::TRAVEL_SAME);
  *request.mutable_left()->mutable_flow_vectors() = seen.left().flow_vectors();
  v1::MatchLandmarksResponse response;
  homing_->MatchLandmarks(Context().get(), request, &response);
  for (const v1::Match& match : response.matches()) {
    journeys.insert(match.journey());
  }
  const auto context = Context();
  const auto stream = homing_->Localize(context.get());
  v1::LocalizeRequest config;
  config.mutable_config()->set_journey(pattern);
  config.mutable_config()->set_travel(v1::TRAVEL_SAME);
  stream->Write(config);
  v1::LocalizeRequest observation;
  *observation.mutable_observation() = seen;
  stream->Write(observation);
  stream->WritesDone();
  v1::LocalizeResponse answer;
  while (stream->Read(&answer)) {
    for (const v1::Match& match : answer.matches()) {
      journeys.insert(match.journey());
    }
  }
  stream->Finish();
  return journeys;
}

grpc::Status EveryRpc::Export(const std::string& journey) {
  const auto context = Context();
  const auto stream =
      journeys_->ExportJourney(context.get(), Named<v1::ExportJourneyRequest>(journey));
  v1::ExportJourneyResponse response;
  while (stream->Read(&response)) {
  }
  return stream->Finish();
}

grpc::Status EveryRpc::BackUp(std::string* file) {
  const auto context = Context();
  const auto stream = store_->BackUpStore(context.get(), {});
  v1::BackUpStoreResponse response;
  while (stream->Read(&response)) {
    if (file != nullptr) *file += response.chunk();
  }
  return stream->Finish();
}

grpc::Status EveryRpc::Import(const std::string& journey) {
  const auto context = Context();
  v1::ImportJourneyResponse response;
  const auto stream = journeys_->ImportJourney(context.get(), &response);
  v1::ImportJourneyRequest request;
  request.set_name(journey);
  stream->Write(request);
  request.set_chunk("no journey file");
  stream->Write(request);
  stream->WritesDone();
  return stream->Finish();
}

grpc::Status EveryRpc::CallJourneys(Rpc rpc, const std::string& journey) {
  const auto context = Context();
  if (rpc == Rpc::kGetJourney) {
    v1::Journey response;
    return journeys_->GetJourney(context.get(), Named<v1::GetJourneyRequest>(journey), &response);
  }
  if (rpc == Rpc::kListJourneys) {
    v1::ListJourneysRequest request;
    request.set_parent(ParentOf(journey));
    v1::ListJourneysResponse response;
    return journeys_->ListJourneys(context.get(), request, &response);
  }
  if (rpc == Rpc::kDeleteJourney) {
    v1::DeleteJourneyResponse response;
    return journeys_->DeleteJourney(context.get(), Named<v1::DeleteJourneyRequest>(journey),
                                    &response);
  }
  if (rpc == Rpc::kFinishJourney) {
    v1::FinishJourneyRequest request;
    request.set_name(journey);
    request.set_writer_id("writer");
    v1::FinishJourneyResponse response;
    return journeys_->FinishJourney(context.get(), request, &response);
  }
  if (rpc == Rpc::kSetReaders) {
    v1::Journey response;
    return journeys_->SetReaders(context.get(), Named<v1::SetReadersRequest>(journey), &response);
  }
  if (rpc == Rpc::kListLandmarks) {
    v1::ListLandmarksRequest request;
    request.set_parent(journey);
    v1::ListLandmarksResponse response;
    return journeys_->ListLandmarks(context.get(), request, &response);
  }
  if (rpc == Rpc::kDescribeRoute) {
    v1::DescribeRouteResponse response;
    return journeys_->DescribeRoute(context.get(), Named<v1::DescribeRouteRequest>(journey),
                                    &response);
  }
  v1::AnalyzeAliasingResponse response;
  return journeys_->AnalyzeAliasing(context.get(), Named<v1::AnalyzeAliasingRequest>(journey),
                                    &response);
}

grpc::Status EveryRpc::CallModels(Rpc rpc) {
  const auto context = Context();
  if (rpc == Rpc::kTrainDeviationModel) {
    v1::TrainDeviationModelRequest request;
    request.set_model_id("default");
    v1::TrainDeviationModelResponse response;
    return models_->TrainDeviationModel(context.get(), request, &response);
  }
  if (rpc == Rpc::kGetDeviationModel) {
    v1::DeviationModel response;
    return models_->GetDeviationModel(
        context.get(), Named<v1::GetDeviationModelRequest>("deviationModels/default"), &response);
  }
  v1::ListDeviationModelsResponse response;
  return models_->ListDeviationModels(context.get(), {}, &response);
}

// Of a stream the first message; then the client leaves.
grpc::Status EveryRpc::CallFleet(Rpc rpc, const std::string& robot) {
  const auto context = Context();
  if (rpc == Rpc::kListRobots) {
    v1::ListRobotsResponse response;
    return fleet_->ListRobots(context.get(), {}, &response);
  }
  bool read = false;
  grpc::Status status;
  if (rpc == Rpc::kWatchFleet) {
    v1::WatchFleetResponse response;
    const auto reader = fleet_->WatchFleet(context.get(), {});
    read = reader->Read(&response);
    if (read) context->TryCancel();
    status = reader->Finish();
  } else {
    v1::WatchRobotResponse response;
    const auto reader = fleet_->WatchRobot(context.get(), Named<v1::WatchRobotRequest>(robot));
    read = reader->Read(&response);
    if (read) context->TryCancel();
    status = reader->Finish();
  }
  return read ? grpc::Status::OK : status;
}

grpc::Status EveryRpc::Call(Rpc rpc, const std::string& journey) {
  switch (rpc) {
    case Rpc::kCreateJourney:
      return Create(journey, {});
    case Rpc::kRecordJourney:
      return Record(journey);
    case Rpc::kExportJourney:
      return Export(journey);
    case Rpc::kImportJourney:
      return Import(journey);
    case Rpc::kMatchLandmarks:
      return Match(journey);
    case Rpc::kLocalize:
      return Localize(journey);
    case Rpc::kTrainDeviationModel:
    case Rpc::kGetDeviationModel:
    case Rpc::kListDeviationModels:
      return CallModels(rpc);
    case Rpc::kBackUpStore:
      return BackUp();
    case Rpc::kListRobots:
    case Rpc::kWatchFleet:
    case Rpc::kWatchRobot:
      return CallFleet(rpc, ParentOf(journey));
    default:
      return CallJourneys(rpc, journey);
  }
}

}  // namespace homing::server
