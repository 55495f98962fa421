// Loads against the server itself, over a real socket.
#include "client/bench/load_run.h"

#include <unistd.h>

#include <fstream>
#include <optional>
#include <thread>

#include "client/bench/http2_endpoint.h"
#include "server/access/certificate_folder.h"
#include "server/access/token_book.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class LoadRunTest : public ServerTest {
 protected:
  LoadRunTest() {
    load_.robots = 4;
    load_.rate = 50;
    load_.seconds = 0.5;
    load_.steps = 30;
    load_.journeys = 2;
  }

  absl::StatusOr<client::LoadResult> Run() {
    connection_.address = address_.value_or(server_->address());
    return client::RunLoad(
        connection_, load_, [](const std::string&) {}, stop_.get_token());
  }
  void ExpectAllAnswered(const absl::StatusOr<client::LoadResult>& result) {
    ASSERT_THAT(result, IsOk());
    EXPECT_THAT(result->counts.status, IsOk());
    EXPECT_EQ(result->failed_robots, 0);
    EXPECT_EQ(result->counts.sent, 4 * 25);
    EXPECT_EQ(result->counts.answered, 4 * 25);
    EXPECT_EQ(result->counts.latency.count(), 4 * 25U);
    EXPECT_EQ(result->counts.first.count(), 4U);
    EXPECT_EQ(result->counts.settled.count(), 0U);
  }

  void MakeChiefAdmin() {
    options_.roles = folder_.File("roles.toml");
    std::ofstream(options_.roles) << "[roles]\n\"operators/chief\" = \"admin\"\n";
  }

  std::optional<std::string> address_;
  client::ConnectionOptions connection_;
  client::LoadOptions load_;
  std::stop_source stop_;
};

TEST_F(LoadRunTest, EachRobotsObservationsAreDurableWhenAnswered) {
  ExpectAllAnswered(Run());
  for (int robot = 0; robot < 4; ++robot) {
    EXPECT_EQ(Get("robots/bench" + std::to_string(robot) + "/journeys/load").next_sequence(), 25);
  }
}

TEST_F(LoadRunTest, RobotsLocalise) {
  load_.localize = true;
  ExpectAllAnswered(Run());
}

TEST_F(LoadRunTest, RobotsBeginOneAfterTheOther) {
  load_.ramp_seconds = 0.4;
  const auto result = Run();
  ExpectAllAnswered(result);
  // The last one begins three quarters of the ramp after the first.
  EXPECT_GT(result->seconds, 0.3 + 0.45);
  load_.ramp_seconds = -1;
  EXPECT_THAT(Run().status(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("ramp")));
}

// Far faster than they are answered, so that many wait on every side.
TEST_F(LoadRunTest, ObservationsStayInOrderWhenTheyComeFast) {
  load_.localize = true;
  load_.robots = 8;
  load_.rate = 1000;
  load_.seconds = 2;
  // A sanitizer's build on a busy machine.
  load_.grace_seconds = 300;
  const auto result = Run();
  ASSERT_THAT(result, IsOk());
  EXPECT_THAT(result->counts.status, IsOk());
  EXPECT_EQ(result->counts.answered, 16'000);
}

// More than one frame of HTTP/2, and more than its first window.
TEST_F(LoadRunTest, LargeMessagesGoThrough) {
  load_.vectors = 20'000;
  ExpectAllAnswered(Run());
}

TEST_F(LoadRunTest, TheReasonOfARefusalIsReported) {
  ExpectAllAnswered(Run());
  ASSERT_THAT(Finish("robots/bench0/journeys/load", "bench"), IsGrpcOk());
  const auto again = Run();
  EXPECT_THAT(again.status(), StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("bench0")));
  load_.localize = true;
  load_.vectors = 200'000;
  EXPECT_THAT(Run().status(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("vectors")));
}

TEST_F(LoadRunTest, AServerThatGoesAwayIsAFailureOfEachRobot) {
  load_.seconds = 3;
  std::jthread away([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    server_.reset();
  });
  const auto result = Run();
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->failed_robots, 4);
  EXPECT_FALSE(result->counts.status.ok());
}

TEST_F(LoadRunTest, AnAddressWithoutAServerIsUnavailable) {
  address_ = "127.0.0.1:1";
  connection_.connect_timeout = std::chrono::milliseconds(500);
  EXPECT_THAT(Run().status(), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("127.0.0.1:1")));
}

TEST_F(LoadRunTest, WithABearerToken) {
  MakeChiefAdmin();
  options_.tokens = folder_.File("tokens.toml");
  ASSERT_THAT(AddToken(options_.tokens, "operators/chief", HashToken("secret")), IsOk());
  StartServer();
  EXPECT_THAT(Run().status(), StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("")));
  connection_.token_file = folder_.File("token");
  std::ofstream(connection_.token_file) << "secret\n";
  ExpectAllAnswered(Run());
}

TEST_F(LoadRunTest, OverTlsWithACertificateOfTheClient) {
  CertificateOrder order;
  order.folder = folder_.File("pki");
  order.operators = {"chief"};
  ASSERT_THAT(MakeCertificates(order), IsOk());
  options_.tls_cert = folder_.File("pki/server.pem");
  options_.tls_key = folder_.File("pki/server.key");
  options_.tls_client_ca = folder_.File("pki/ca.pem");
  MakeChiefAdmin();
  StartServer();
  connection_.tls_ca = folder_.File("pki/ca.pem");
  EXPECT_THAT(Run().status(), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("TLS")));
  connection_.tls_cert = folder_.File("pki/operators/chief.pem");
  connection_.tls_key = folder_.File("pki/operators/chief.key");
  ExpectAllAnswered(Run());
  // 127.1 leads to the same server, but is not in its certificate; it is not a valid name either.
  connection_.address = "127.1" + server_->address().substr(server_->address().rfind(':'));
  const auto other = client::Http2Endpoint::Make(connection_);
  ASSERT_THAT(other, IsOk());
  const int socket = other->Dial().value();
  EXPECT_THAT(other->Secure(socket).status(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("TLS")));
  close(socket);
}

}  // namespace
}  // namespace homing::server
