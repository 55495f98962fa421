#include "client/journey_client.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/chunk_file.h"
#include "client/rpc_status.h"
#include "client/unary_call.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr int kPageSize = 1000;
constexpr std::size_t kChunkBytes = 256 * 1024;

}  // namespace

absl::StatusOr<JourneyName> ParseJourneyName(const std::string& name) {
  const std::vector<std::string> parts = absl::StrSplit(name, '/');
  const bool good = parts.size() == 4 && parts[0] == "robots" && !parts[1].empty() &&
                    parts[2] == "journeys" && !parts[3].empty();
  if (!good) {
    return TextMustBe("journey", name, "robots/ROBOT/journeys/JOURNEY");
  }
  return JourneyName{absl::StrCat("robots/", parts[1]), parts[3]};
}

JourneyClient::JourneyClient(const Connection* connection, std::stop_token stop)
    : connection_(connection),
      stop_(std::move(stop)),
      stub_(v1::JourneyService::NewStub(connection->channel())) {}

absl::StatusOr<v1::Journey> JourneyClient::Create(const v1::CreateJourneyRequest& request) {
  return CallUnary<v1::Journey>(*connection_, stop_, [&](auto* context, auto* response) {
    return stub_->CreateJourney(context, request, response);
  });
}

absl::StatusOr<v1::Journey> JourneyClient::Get(const std::string& name) {
  v1::GetJourneyRequest request;
  request.set_name(name);
  return CallUnary<v1::Journey>(*connection_, stop_, [&](auto* context, auto* response) {
    return stub_->GetJourney(context, request, response);
  });
}

absl::Status JourneyClient::Delete(const std::string& name) {
  v1::DeleteJourneyRequest request;
  request.set_name(name);
  return CallUnary<v1::DeleteJourneyResponse>(*connection_, stop_,
                                              [&](auto* context, auto* response) {
                                                return stub_->DeleteJourney(context, request,
                                                                            response);
                                              })
      .status();
}

absl::StatusOr<v1::Journey> JourneyClient::Finish(const std::string& name,
                                                  const std::string& writer_id, bool force) {
  v1::FinishJourneyRequest request;
  request.set_name(name);
  request.set_writer_id(writer_id);
  request.set_force(force);
  HOMING_ASSIGN_OR_RETURN(
      const auto response,
      CallUnary<v1::FinishJourneyResponse>(*connection_, stop_, [&](auto* context, auto* answer) {
        return stub_->FinishJourney(context, request, answer);
      }));
  return response.journey();
}

absl::StatusOr<v1::Journey> JourneyClient::SetReaders(const std::string& name,
                                                      const std::vector<std::string>& readers) {
  v1::SetReadersRequest request;
  request.set_name(name);
  for (const std::string& reader : readers) request.add_readers(reader);
  return CallUnary<v1::Journey>(*connection_, stop_, [&](auto* context, auto* response) {
    return stub_->SetReaders(context, request, response);
  });
}

absl::Status JourneyClient::List(const std::string& parent,
                                 const std::function<absl::Status(const v1::Journey&)>& each) {
  v1::ListJourneysRequest request;
  request.set_parent(parent);
  request.set_page_size(kPageSize);
  do {
    HOMING_ASSIGN_OR_RETURN(
        const auto page,
        CallUnary<v1::ListJourneysResponse>(*connection_, stop_, [&](auto* context, auto* answer) {
          return stub_->ListJourneys(context, request, answer);
        }));
    for (const v1::Journey& journey : page.journeys()) HOMING_RETURN_IF_ERROR(each(journey));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return absl::OkStatus();
}

absl::Status JourneyClient::ListLandmarks(
    const std::string& journey, bool include_fingerprints,
    const std::function<absl::Status(const v1::Landmark&)>& each) {
  v1::ListLandmarksRequest request;
  request.set_parent(journey);
  request.set_page_size(kPageSize);
  request.set_include_fingerprints(include_fingerprints);
  do {
    HOMING_ASSIGN_OR_RETURN(
        const auto page,
        CallUnary<v1::ListLandmarksResponse>(*connection_, stop_, [&](auto* context, auto* answer) {
          return stub_->ListLandmarks(context, request, answer);
        }));
    for (const v1::Landmark& landmark : page.landmarks()) HOMING_RETURN_IF_ERROR(each(landmark));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return absl::OkStatus();
}

absl::StatusOr<v1::DescribeRouteResponse> JourneyClient::DescribeRoute(const std::string& journey) {
  v1::DescribeRouteRequest request;
  request.set_name(journey);
  request.set_columns(1);
  return CallUnary<v1::DescribeRouteResponse>(
      *connection_, stop_,
      [&](auto* context, auto* answer) { return stub_->DescribeRoute(context, request, answer); });
}

absl::StatusOr<v1::AnalyzeAliasingResponse> JourneyClient::AnalyzeAliasing(
    const std::string& journey, int tolerance_steps) {
  v1::AnalyzeAliasingRequest request;
  request.set_name(journey);
  request.set_tolerance_steps(tolerance_steps);
  return CallUnary<v1::AnalyzeAliasingResponse>(
      *connection_, stop_, [&](auto* context, auto* answer) {
        return stub_->AnalyzeAliasing(context, request, answer);
      });
}

absl::Status JourneyClient::Export(const std::string& name, std::ostream& file) {
  grpc::ClientContext context;
  const std::stop_callback cancel(stop_, [&context] { context.TryCancel(); });
  v1::ExportJourneyRequest request;
  request.set_name(name);
  const auto reader = stub_->ExportJourney(&context, request);
  return WriteChunks<v1::ExportJourneyResponse>(*reader, &context, file);
}

absl::StatusOr<v1::Journey> JourneyClient::Import(const std::string& name, std::istream& file) {
  grpc::ClientContext context;
  const std::stop_callback cancel(stop_, [&context] { context.TryCancel(); });
  v1::ImportJourneyResponse response;
  const auto writer = stub_->ImportJourney(&context, &response);
  v1::ImportJourneyRequest request;
  request.set_name(name);
  bool open = writer->Write(request);
  std::string chunk(kChunkBytes, '\0');
  while (open && file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    if (file.gcount() == 0) break;
    request.set_chunk(chunk.data(), static_cast<std::size_t>(file.gcount()));
    open = writer->Write(request);
  }
  writer->WritesDone();
  HOMING_RETURN_IF_ERROR(FromGrpc(writer->Finish()));
  return response.journey();
}

}  // namespace homing::client
