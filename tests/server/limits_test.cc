// Limits over a real socket: each has its code, its reason, and a place among the metrics.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <future>

#include "homing/image/frame.h"
#include "tests/server/server_fixture.h"
#include "tests/support/journey_file.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class LimitsTest : public ServerTest {
 protected:
  void Restart() {
    StartServer();
    ASSERT_THAT(Create(), IsGrpcOk());
  }
  void ExpectCounted(const std::string& code, const std::string& reason) {
    EXPECT_THAT(server_->MetricsText(),
                HasSubstr("homing_errors_total{code=\"" + code + "\",reason=\"" + reason + "\"}"));
  }
  // A refusal that may be retried.
  void ExpectExhausted(const grpc::Status& status, const std::string& reason) {
    EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("")));
    EXPECT_EQ(ReasonOf(status), reason);
    EXPECT_TRUE(HasRetryInfo(status));
    ExpectCounted("RESOURCE_EXHAUSTED", reason);
  }
};

TEST_F(LimitsTest, StreamsInAll) {
  options_.limits.max_streams = 1;
  Restart();
  Recording first(journeys_.get(), kJourney);
  first.Record(test::FlowAt(0));
  ExpectExhausted(Localizing(homing_.get(), LocalizeOn(kJourney)).AwaitEnd(), "STREAMS");
  EXPECT_THAT(server_->MetricsText(), HasSubstr("homing_open_streams 1"));
  EXPECT_THAT(first.Close(), IsGrpcOk());
  EXPECT_THAT(Localizing(homing_.get(), LocalizeOn(kJourney)).Close(), IsGrpcOk());
}

TEST_F(LimitsTest, StreamsOfOneRobot) {
  options_.limits.max_robot_streams = 1;
  Restart();
  Recording first(journeys_.get(), kJourney);
  first.Record(test::FlowAt(0));
  ExpectExhausted(Localizing(homing_.get(), LocalizeOn(kJourney)).AwaitEnd(), "ROBOT_STREAMS");
  EXPECT_THAT(Localizing(homing_.get(), LocalizeOn("robots/-/journeys/-")).Close(), IsGrpcOk());
}

TEST_F(LimitsTest, ObservationsASecondAndNothingAcknowledgedIsLost) {
  options_.limits.max_robot_rate = 5;
  Restart();
  Recording recording(journeys_.get(), kJourney);
  for (int place = 0; place < 11; ++place) {
    recording.Send(test::FlowAt(place));
  }
  ExpectExhausted(recording.AwaitEnd(), "RATE");
  EXPECT_EQ(Get().next_sequence(), 10);
  EXPECT_EQ(recording.answers().back().next_sequence(), 10);
  Wait(std::chrono::seconds(1));
  Recording later(journeys_.get(), kJourney);
  EXPECT_EQ(later.Record(test::FlowAt(10)).next_sequence(), 11);
}

TEST_F(LimitsTest, RobotsThatLocaliseOnAWildcardDoNotSlowEachOther) {
  options_.limits.max_robot_rate = 5;
  Restart();
  RecordFlow(0, 5);
  Localizing first(homing_.get(), LocalizeOn("robots/-/journeys/-"));
  Localizing second(homing_.get(), LocalizeOn("robots/-/journeys/-"));
  for (int place = 0; place < 10; ++place) {
    first.Localize(test::FlowAt(place));
    second.Localize(test::FlowAt(place));
  }
  EXPECT_THAT(second.Close(), IsGrpcOk());
  first.Send(test::FlowAt(10));
  ExpectExhausted(first.AwaitEnd(), "RATE");
}

TEST_F(LimitsTest, JourneysAndBytesOfOneRobot) {
  options_.limits.max_robot_journeys = 2;
  Restart();
  ASSERT_THAT(Create("second"), IsGrpcOk());
  ExpectExhausted(Create("third"), "ROBOT_JOURNEYS");
  EXPECT_THAT(Create("second"), IsGrpcOk());
  RecordFlow(0, 20);
  const std::string file = Export();
  ExpectExhausted(Import("robots/r/journeys/third", file), "ROBOT_JOURNEYS");
  options_.limits.max_robot_journeys = 0;
  options_.limits.max_robot_bytes = 1000;
  StartServer();
  ExpectExhausted(Recording(journeys_.get(), kJourney).AwaitEnd(), "ROBOT_BYTES");
}

TEST_F(LimitsTest, SizeOfTheDatabase) {
  options_.limits.max_database = 200'000;
  Restart();
  Recording recording(journeys_.get(), kJourney);
  v1::RecordJourneyResponse response;
  // Reads one answer for each observation sent before it.
  for (int place = 0; recording.Send(test::FlowAt(place)) && recording.Read(&response); ++place) {
  }
  const grpc::Status status = recording.AwaitEnd();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("")));
  EXPECT_TRUE(HasRetryInfo(status));
  EXPECT_GE(Get().next_sequence(), response.next_sequence());
}

TEST_F(LimitsTest, PixelsAndVectorsAreNeverWorthARetry) {
  options_.max_pixels = 1000;
  options_.max_vectors = 3;
  Restart();
  Observation frame;
  const std::string wall = test::WallAt(0, Side::kLeft);
  frame.views[0] = test::GrayFrame(wall);
  Recording frames(journeys_.get(), kJourney);
  frames.Send(frame);
  const grpc::Status pixels = frames.AwaitEnd();
  EXPECT_THAT(pixels, GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("1000 pixels")));
  EXPECT_EQ(ReasonOf(pixels), "PIXELS");
  EXPECT_FALSE(HasRetryInfo(pixels));
  ExpectCounted("INVALID_ARGUMENT", "PIXELS");
  Recording vectors(journeys_.get(), kJourney);
  vectors.Send(test::FlowAt(0));
  EXPECT_EQ(ReasonOf(vectors.AwaitEnd()), "VECTORS");
  ExpectCounted("INVALID_ARGUMENT", "VECTORS");
}

TEST_F(LimitsTest, AStreamOnWhichNothingMovesIsClosedAndMayComeBack) {
  options_.limits.idle_stream_s = 60;
  Restart();
  Recording recording(journeys_.get(), kJourney);
  recording.Record(test::FlowAt(0));
  auto end = std::async(std::launch::async, [&recording] { return recording.AwaitEnd(); });
  // The server may note that its answer has left only after the clock was moved: more than once.
  do {
    Wait(std::chrono::seconds(61));
  } while (end.wait_for(std::chrono::seconds(2)) != std::future_status::ready);
  const grpc::Status status = end.get();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("too long")));
  EXPECT_EQ(ReasonOf(status), "IDLE");
  EXPECT_TRUE(HasRetryInfo(status));
  ExpectCounted("UNAVAILABLE", "IDLE");
  Recording again(journeys_.get(), kJourney);
  EXPECT_EQ(again.Record(test::FlowAt(1)).next_sequence(), 2);
}

TEST_F(LimitsTest, FilesBeingImportedShareTheMemory) {
  options_.limits.memory_quota = 16 << 20;
  Restart();
  const std::string file(17 << 20, 'x');
  ExpectExhausted(Import("robots/r/journeys/copy", file, 1 << 20), "IMPORT_MEMORY");
  EXPECT_THAT(Import("robots/r/journeys/copy", file.substr(0, 1 << 20), 1 << 20),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("journey file")));
}

TEST_F(LimitsTest, FilesBeingExportedShareTheMemory) {
  const std::string file = test::JourneyFile(300'000, 2);
  options_.limits.memory_quota = static_cast<std::int64_t>(file.size() * 3 / 2);
  Restart();
  ASSERT_THAT(Import("robots/r/journeys/large", file, 1 << 20), IsGrpcOk());
  v1::ExportJourneyRequest request;
  request.set_name("robots/r/journeys/large");
  v1::ExportJourneyResponse response;
  // Reads a first chunk, and no more.
  grpc::ClientContext slow_context;
  const auto slow = journeys_->ExportJourney(&slow_context, request);
  ASSERT_TRUE(slow->Read(&response));
  const auto read_all = [&] {
    grpc::ClientContext context;
    const auto stream = journeys_->ExportJourney(&context, request);
    while (stream->Read(&response)) {
    }
    return stream->Finish();
  };
  ExpectExhausted(read_all(), "EXPORT_MEMORY");
  slow_context.TryCancel();
  while (slow->Read(&response)) {
  }
  EXPECT_EQ(slow->Finish().error_code(), grpc::StatusCode::CANCELLED);
  // The server sees the cancellation a moment later; a test that hangs is ended by the runner.
  while (!read_all().ok()) {
  }
  EXPECT_EQ(Export("robots/r/journeys/large"), file);
}

TEST_F(LimitsTest, StreamsThatLocaliseShareTheMemory) {
  options_.limits.memory_quota = 16 << 20;
  Restart();
  constexpr char kLong[] = "robots/r/journeys/long";
  ASSERT_THAT(Import(kLong, test::JourneyFile(70'000, 0), 1 << 20), IsGrpcOk());
  Localizing first(homing_.get(), LocalizeOn(kLong));
  first.Localize(test::FlowAt(0));
  Localizing second(homing_.get(), LocalizeOn(kLong));
  second.Send(test::FlowAt(0));
  ExpectExhausted(second.AwaitEnd(), "LOCALIZE_MEMORY");
  EXPECT_THAT(first.Close(), IsGrpcOk());
  // The server frees the stream a moment later; a test that hangs is ended by the runner.
  const auto again = [&] {
    Localizing stream(homing_.get(), LocalizeOn(kLong));
    stream.Send(test::FlowAt(0));
    return stream.Close();
  };
  while (!again().ok()) {
  }
}

// The answer to GET of `path` at `address`.
std::string HttpGet(const std::string& address, const std::string& path) {
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  const int file = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(file, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  const std::string request = "GET " + path + " HTTP/1.0\r\nHost: localhost\r\n\r\n";
  EXPECT_EQ(::send(file, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  std::string answer;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::recv(file, buffer, sizeof(buffer), 0)) > 0;) {
    answer.append(buffer, static_cast<std::size_t>(n));
  }
  ::close(file);
  return answer;
}

TEST_F(LimitsTest, MetricsAreServedOverHttpAndNothingElseIs) {
  options_.http = "127.0.0.1:0";
  Restart();
  RecordFlow(0, 5);
  Localizing localizing(homing_.get(), LocalizeOn(kJourney));
  localizing.Localize(test::FlowAt(0));
  ASSERT_THAT(localizing.Close(), IsGrpcOk());
  const std::string answer = HttpGet(server_->metrics_address(), "/metrics");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  for (const char* line :
       {"grpc_server_call_started_total{grpc_method=\"homing.v1.JourneyService/RecordJourney\"} 1",
        "grpc_server_call_duration_seconds_count{grpc_method=\"homing.v1.HomingService/"
        "Localize\",grpc_status=\"OK\"} 1",
        "homing_observations_received_total{grpc_method=\"homing.v1.JourneyService/"
        "RecordJourney\"} 5",
        "homing_db_appends_total 5", "homing_db_commit_duration_seconds_count",
        "homing_query_duration_seconds_count 1", "homing_ingest_queue_depth 0",
        "homing_worker_queue_depth", "homing_build_info{version=", "process_start_time_seconds",
        "homing_robots_lost 0", "homing_query_results_total{outcome=\"UNKNOWN_PLACE\"}",
        "homing_errors_total{code=\"UNAVAILABLE\",reason=\"IDLE\"} 0",
        "homing_limit{limit=\"max-streams\"} 4096", "homing_db_size_bytes",
        "process_resident_memory_bytes", "process_open_fds"}) {
    EXPECT_THAT(answer, HasSubstr(line));
  }
  for (const std::string limit :
       {"PIXELS", "VECTORS", "STREAMS", "ROBOT_STREAMS", "RATE", "ROBOT_JOURNEYS", "ROBOT_BYTES",
        "IMPORT_MEMORY", "EXPORT_MEMORY", "LOCALIZE_MEMORY", "IMAGE_MEMORY", "MAP_CACHE", "IDLE"}) {
    EXPECT_THAT(answer, HasSubstr("reason=\"" + limit + "\"} 0"));
  }
  EXPECT_THAT(answer, Not(HasSubstr("robots/")));
  for (const char* path : {"/etc/passwd", "/../etc/passwd", "/metrics/../../etc/passwd"}) {
    EXPECT_THAT(HttpGet(server_->metrics_address(), path),
                AllOf(Not(HasSubstr("root:")), Not(StartsWith("HTTP/1.1 200"))))
        << path;
  }
}

TEST_F(LimitsTest, AnHttpAddressThatIsTakenIsAnErrorOnlyIfItWasAskedFor) {
  options_.http = "127.0.0.1:0";
  StartServer();
  ServerOptions second = options_;
  second.http = server_->metrics_address();
  second.database = "sqlite:" + folder_.File("other.db");
  EXPECT_THAT(HomingServer::Start(second),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("http: ")));
  second.http_optional = true;
  const auto started = HomingServer::Start(second);
  ASSERT_THAT(started, IsOk());
  EXPECT_EQ((*started)->metrics_address(), "");
}

}  // namespace
}  // namespace homing::server
