#include "tests/server/server_fixture.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "google/rpc/error_details.pb.h"
#include "proto/wire/observation_conversion.h"
#include "tests/support/connected.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

// The detail of type T, if the status has one.
template <typename T>
std::optional<T> DetailOf(const grpc::Status& status) {
  google::rpc::Status details;
  details.ParseFromString(status.error_details());
  for (const auto& any : details.details()) {
    T detail;
    if (any.UnpackTo(&detail)) {
      return detail;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string ReasonOf(const grpc::Status& status) {
  const auto info = DetailOf<google::rpc::ErrorInfo>(status);
  return info && info->domain() == "homing" ? info->reason() : "";
}

bool HasRetryInfo(const grpc::Status& status) {
  return DetailOf<google::rpc::RetryInfo>(status).has_value();
}

grpc::Status AfterStreamEnd(const std::function<grpc::Status()>& call) {
  grpc::Status status = call();
  for (int i = 0; i < 500 && status.error_code() == grpc::StatusCode::ABORTED; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    status = call();
  }
  return status;
}

std::string BadFieldOf(const grpc::Status& status) {
  const auto bad = DetailOf<google::rpc::BadRequest>(status);
  return bad && bad->field_violations_size() == 1 ? bad->field_violations(0).field() : "";
}

v1::RecordJourneyRequest RecordRequest(const Observation& observation) {
  v1::RecordJourneyRequest request;
  *request.mutable_observation() = wire::ToProto(observation);
  return request;
}

v1::LocalizeRequest LocalizeRequestOf(const Observation& observation) {
  v1::LocalizeRequest request;
  *request.mutable_observation() = wire::ToProto(observation);
  return request;
}

Recording::Recording(v1::JourneyService::Stub* stub, const std::string& journey,
                     const std::string& writer)
    : stream_(stub->RecordJourney(&context_)) {
  if (!journey.empty()) {
    v1::RecordJourneyRequest request;
    request.mutable_config()->set_journey(journey);
    request.mutable_config()->set_writer_id(writer);
    stream_->Write(request);
  }
}

v1::RecordJourneyResponse Recording::Record(const Observation& observation) {
  EXPECT_TRUE(Send(observation));
  v1::RecordJourneyResponse response;
  // The first answer, to the config, may come before.
  do {
    if (!Read(&response)) {
      ADD_FAILURE() << "the stream ended: " << stream_->Finish().error_message();
      return {};
    }
    answers_.push_back(response);
  } while (!response.has_sequence());
  return response;
}

grpc::Status Recording::AwaitEnd() {
  v1::RecordJourneyResponse response;
  while (Read(&response)) {
    answers_.push_back(response);
  }
  return stream_->Finish();
}

grpc::Status Recording::Close() {
  stream_->WritesDone();
  return AwaitEnd();
}

Localizing::Localizing(v1::HomingService::Stub* stub, const v1::LocalizeConfig& config)
    : stream_(stub->Localize(&context_)) {
  v1::LocalizeRequest request;
  *request.mutable_config() = config;
  stream_->Write(request);
}

v1::LocalizeResponse Localizing::Localize(const Observation& observation) {
  EXPECT_TRUE(Send(observation));
  v1::LocalizeResponse response;
  if (!stream_->Read(&response)) {
    ADD_FAILURE() << "the stream ended: " << stream_->Finish().error_message();
  }
  return response;
}

grpc::Status Localizing::AwaitEnd() {
  v1::LocalizeResponse response;
  while (stream_->Read(&response)) {
  }
  return stream_->Finish();
}

grpc::Status Localizing::Close() {
  stream_->WritesDone();
  return AwaitEnd();
}

void ServerTest::StartServer() {
  server_.reset();
  options_.listen = "127.0.0.1:0";
  options_.database = folder_.Database();
  auto server = HomingServer::Start(
      options_, [elapsed = elapsed_s_] { return TimePoint{} + std::chrono::seconds(*elapsed); });
  ASSERT_THAT(server, IsOk());
  server_ = *std::move(server);
  ConnectTo(server_->address());
}

void ServerTest::ConnectTo(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  // None of them is ever ready on a server that wants TLS.
  const auto channel =
      options_.tls_cert.empty()
          ? ConnectedChannel(address, arguments)
          : grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
  journeys_ = v1::JourneyService::NewStub(channel);
  homing_ = v1::HomingService::NewStub(channel);
  models_ = v1::DeviationModelService::NewStub(channel);
}

grpc::Status ServerTest::Create(const std::string& journey_id, const std::string& writer,
                                v1::Journey* made) {
  grpc::ClientContext context;
  v1::CreateJourneyRequest request;
  request.set_parent("robots/r");
  request.set_journey_id(journey_id);
  request.set_writer_id(writer);
  v1::Journey ignored;
  return journeys_->CreateJourney(&context, request, made != nullptr ? made : &ignored);
}

grpc::Status ServerTest::Finish(const std::string& name, const std::string& writer) {
  grpc::ClientContext context;
  v1::FinishJourneyRequest request;
  request.set_name(name);
  request.set_writer_id(writer);
  v1::FinishJourneyResponse response;
  return journeys_->FinishJourney(&context, request, &response);
}

v1::Journey ServerTest::Get(const std::string& name) {
  grpc::ClientContext context;
  v1::GetJourneyRequest request;
  request.set_name(name);
  v1::Journey journey;
  EXPECT_THAT(journeys_->GetJourney(&context, request, &journey), IsGrpcOk());
  return journey;
}

std::string ServerTest::Export(const std::string& name) {
  grpc::ClientContext context;
  v1::ExportJourneyRequest request;
  request.set_name(name);
  const auto stream = journeys_->ExportJourney(&context, request);
  std::string file;
  v1::ExportJourneyResponse response;
  while (stream->Read(&response)) {
    file += response.chunk();
  }
  EXPECT_THAT(stream->Finish(), IsGrpcOk());
  EXPECT_FALSE(file.empty());
  return file;
}

grpc::Status ServerTest::Import(const std::string& name, const std::string& file,
                                std::size_t chunk) {
  grpc::ClientContext context;
  v1::ImportJourneyResponse response;
  const auto stream = journeys_->ImportJourney(&context, &response);
  v1::ImportJourneyRequest request;
  if (!name.empty()) {
    request.set_name(name);
    stream->Write(request);
  }
  for (std::size_t begin = 0; begin < file.size(); begin += chunk) {
    request.set_chunk(file.substr(begin, chunk));
    stream->Write(request);
  }
  stream->WritesDone();
  return stream->Finish();
}

void ServerTest::RecordFlow(int first, int last, const std::string& name) {
  Recording recording(journeys_.get(), name);
  for (int place = first; place < last; ++place) {
    EXPECT_EQ(recording.Record(test::FlowAt(place)).next_sequence(), place + 1);
  }
  EXPECT_THAT(recording.Close(), IsGrpcOk());
}

v1::LocalizeConfig LocalizeOn(const std::string& journey, v1::Travel travel) {
  v1::LocalizeConfig config;
  config.set_journey(journey);
  config.set_travel(travel);
  return config;
}

}  // namespace homing::server
