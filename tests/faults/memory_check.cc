// Requests that are small and want much memory: the server's peak is bounded.
#include <grpcpp/grpcpp.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/png_file.h"
#include "homing/base/file_text.h"
#include "homing/v1/homing_service.grpc.pb.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "proto/wire/observation_conversion.h"
#include "tests/faults/checks.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/journey_file.h"
#include "tests/support/route.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

// The server has 256 MiB for messages and files, and as much for maps; a file needs a few times its
// size while it is read.
constexpr double kMostMib = 1024;
constexpr char kSteps[] = "robots/1/journeys/steps";
constexpr char kLandmarks[] = "robots/1/journeys/landmarks";

// Resident memory at its peak since ForgetPeak.
double PeakMib(pid_t process) {
  std::ifstream status(absl::StrCat("/proc/", process, "/status"));
  std::string word;
  double kib = 0;
  while (status >> word && word != "VmHWM:") {
  }
  status >> kib;
  return kib / 1024;
}

void ForgetPeak(pid_t process) {
  std::ofstream(absl::StrCat("/proc/", process, "/clear_refs")) << 5;
}

class Bombs {
 public:
  Bombs(const ServerUnderTest& server, Figures* figures) : server_(server), figures_(figures) {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(-1);
    channel_ =
        grpc::CreateCustomChannel(server.address(), grpc::InsecureChannelCredentials(), arguments);
    journeys_ = v1::JourneyService::NewStub(channel_);
    homing_ = v1::HomingService::NewStub(channel_);
  }

  bool Import(const char* name, const std::string& file) {
    grpc::ClientContext context;
    v1::ImportJourneyResponse response;
    const auto stream = journeys_->ImportJourney(&context, &response);
    v1::ImportJourneyRequest request;
    request.set_name(name);
    stream->Write(request);
    for (std::size_t begin = 0; begin < file.size(); begin += 1 << 20) {
      request.set_chunk(file.substr(begin, 1 << 20));
      stream->Write(request);
    }
    stream->WritesDone();
    const grpc::Status status = stream->Finish();
    if (!status.ok()) std::cerr << "import: " << status.error_message() << '\n';
    return status.ok();
  }

  // Streams that localise, each with one observation.
  void Localize(const char* figure, const char* journey, int count,
                const v1::Observation& observation) {
    std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
    std::vector<
        std::unique_ptr<grpc::ClientReaderWriter<v1::LocalizeRequest, v1::LocalizeResponse>>>
        streams;
    for (int i = 0; i < count; ++i) {
      contexts.push_back(std::make_unique<grpc::ClientContext>());
      streams.push_back(homing_->Localize(contexts.back().get()));
      v1::LocalizeRequest request;
      request.mutable_config()->set_journey(journey);
      request.mutable_config()->set_travel(v1::TRAVEL_SAME);
      streams.back()->Write(request);
      *request.mutable_observation() = observation;
      streams.back()->Write(request);
    }
    v1::LocalizeResponse response;
    for (const auto& stream : streams) stream->Read(&response);
    Report(figure);
    for (const auto& context : contexts) context->TryCancel();
    for (const auto& stream : streams) stream->Finish();
  }

  // Streams along a map of two million empty steps.
  void Steps() { Localize("bomb_steps_mib", kSteps, 16, wire::ToProto(test::FlowAt(0))); }

  // Images of few bytes and 16 million pixels.
  void Images(const std::string& png) {
    v1::Observation observation;
    v1::Frame* const frame = observation.mutable_left()->mutable_frame();
    frame->set_encoding(v1::FRAME_ENCODING_PNG);
    frame->set_data(png);
    Localize("bomb_images_mib", kLandmarks, 48, observation);
  }

  // 200 fingerprints that are similar to all stored ones.
  void Matches() {
    const v1::MatchLandmarksRequest request = test::ManyFingerprints(kLandmarks);
    grpc::ClientContext context;
    v1::MatchLandmarksResponse response;
    const grpc::Status status = homing_->MatchLandmarks(&context, request, &response);
    figures_->Holds("bomb_matches_answered", status.ok() && response.matches_size() == 4);
    Report("bomb_matches_mib");
  }

  // Files that nobody reads.
  void Exports() {
    std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
    std::vector<std::unique_ptr<grpc::ClientReader<v1::ExportJourneyResponse>>> streams;
    v1::ExportJourneyRequest request;
    request.set_name(kLandmarks);
    for (int i = 0; i < 150; ++i) {
      contexts.push_back(std::make_unique<grpc::ClientContext>());
      streams.push_back(journeys_->ExportJourney(contexts.back().get(), request));
    }
    v1::ExportJourneyResponse response;
    for (const auto& stream : streams) stream->Read(&response);
    Report("bomb_exports_mib");
    for (const auto& context : contexts) context->TryCancel();
    for (const auto& stream : streams) stream->Finish();
  }

  void Report(const char* name) {
    figures_->AtMost(name, PeakMib(server_.pid()), kMostMib);
    ForgetPeak(server_.pid());
  }

 private:
  const ServerUnderTest& server_;
  Figures* const figures_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::JourneyService::Stub> journeys_;
  std::unique_ptr<v1::HomingService::Stub> homing_;
};

}  // namespace

void CheckMemory(const Programs& programs, Figures* figures) {
  const TemporaryFolder folder;
  ServerUnderTest server(programs.server, folder.File(""));
  if (!server.Start({}, {"--http", "off", "--memory-quota", "256MiB", "--map-cache", "256MiB"})) {
    return figures->Failed("bombs", "no server");
  }
  client::SourceFrame flat;
  flat.width = 4096;
  flat.height = 4096;
  flat.data.assign(static_cast<std::size_t>(4096) * 4096, '\x40');
  const std::string png = folder.File("flat.png");
  if (!client::WritePng(png, flat).ok()) return figures->Failed("bombs", "no image");
  Bombs bombs(server, figures);
  if (!bombs.Import(kSteps, test::JourneyFile(2'000'000, 0)) ||
      !bombs.Import(kLandmarks, test::JourneyFile(200'000, 2))) {
    return figures->Failed("bombs", "no journeys");
  }
  bombs.Report("bomb_imports_mib");
  bombs.Steps();
  bombs.Matches();
  bombs.Exports();
  bombs.Images(ReadFile(png).value_or(""));
  figures->AtMost("bombs_exit_code", server.Stop(), 0);
}

}  // namespace homing::faults
