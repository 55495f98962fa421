#include "client/connection.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "client/rpc_status.h"
#include "google/rpc/error_details.pb.h"
#include "tests/client/fake_journey_service.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::client {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

grpc::Status WithRetryInfo(grpc::StatusCode code, std::int64_t seconds) {
  google::rpc::RetryInfo info;
  info.mutable_retry_delay()->set_seconds(seconds);
  google::rpc::Status details;
  details.add_details()->PackFrom(info);
  return {code, "later", details.SerializeAsString()};
}

TEST(ConnectionTest, NamesTheAddressWhereNothingAnswers) {
  ConnectionOptions options;
  options.address = "127.0.0.1:1";
  const auto connection = Connection::Open(options);
  ASSERT_THAT(connection, IsOk());
  EXPECT_THAT(connection->WaitForServer(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("127.0.0.1:1")));
}

TEST(ConnectionTest, IsReadyOnceTheServerAnswers) {
  FakeJourneyService service({});
  FakeServer server(&service);
  ConnectionOptions options;
  options.address = server.address();
  const auto connection = Connection::Open(options);
  ASSERT_THAT(connection, IsOk());
  EXPECT_THAT(connection->WaitForServer(), IsOk());
}

TEST(ConnectionTest, AServerThatComesUpAfterTheFirstRefusalIsFound) {
  FakeJourneyService service({});
  auto server = std::make_unique<FakeServer>(&service);
  const int port = server->port();
  ConnectionOptions options;
  options.address = server->address();
  server.reset();
  const auto connection = Connection::Open(options);
  ASSERT_THAT(connection, IsOk());
  const auto deadline = std::chrono::system_clock::now() + std::chrono::seconds(5);
  for (auto state = connection->channel()->GetState(true); state != GRPC_CHANNEL_TRANSIENT_FAILURE;
       state = connection->channel()->GetState(true)) {
    ASSERT_TRUE(connection->channel()->WaitForStateChange(state, deadline));
  }
  server = std::make_unique<FakeServer>(&service, port);
  EXPECT_THAT(connection->WaitForServer(), IsOk());
}

TEST(ConnectionTest, WantsCertificateAndKeyTogether) {
  ConnectionOptions options;
  options.tls_cert = "robot.pem";
  EXPECT_THAT(Connection::Open(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--tls-key")));
}

TEST(ConnectionTest, NamesThePemFileThatIsMissing) {
  ConnectionOptions options;
  options.tls_ca = "/does/not/exist.pem";
  EXPECT_THAT(Connection::Open(options),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/does/not/exist.pem")));
}

std::string TokenFile(const TemporaryFolder& folder, const std::string& text) {
  std::ofstream(folder.File("token")) << text;
  return folder.File("token");
}

TEST(ConnectionTest, SendsNoTokenInPlainTextOffThisMachine) {
  const TemporaryFolder folder;
  ConnectionOptions options;
  options.token_file = TokenFile(folder, "t0ken\n");
  for (const char* address : {"127.0.0.1:1", "localhost:1", "[::1]:1", "unix:/tmp/x"}) {
    options.address = address;
    EXPECT_THAT(Connection::Open(options), IsOk()) << address;
  }
  for (const char* address : {"10.0.0.1:1", "127.0.0.1.example.org:1", "localhost.example.org:1"}) {
    options.address = address;
    EXPECT_THAT(Connection::Open(options),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         AllOf(HasSubstr("plain text"), Not(HasSubstr("t0ken")))))
        << address;
  }
  options.insecure = true;
  EXPECT_THAT(Connection::Open(options), IsOk());
}

TEST(ConnectionTest, ATokenIsOnePrintableWord) {
  const TemporaryFolder folder;
  ConnectionOptions options;
  for (const char* text : {"", "\n", "two words", "a\nb"}) {
    options.token_file = TokenFile(folder, text);
    EXPECT_THAT(Connection::Open(options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--token-file")));
  }
  options.token_file = folder.File("none");
  EXPECT_THAT(Connection::Open(options),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("--token-file")));
}

TEST(ConnectionTest, RetriesUntilTheCallSucceeds) {
  const auto connection = Connection::Open({});
  ASSERT_THAT(connection, IsOk());
  int calls = 0;
  EXPECT_THAT(
      connection->Retry(
          {}, [&] { return ++calls < 3 ? absl::UnavailableError("draining") : absl::OkStatus(); }),
      IsOk());
  EXPECT_EQ(calls, 3);
}

TEST(ConnectionTest, WaitsOneStepOfTheBackoffBeforeEachAttempt) {
  // A connection that is ready: else each attempt waits for the server as well.
  FakeJourneyService service({});
  FakeServer server(&service);
  ConnectionOptions options;
  options.address = server.address();
  const auto connection = Connection::Open(options);
  ASSERT_THAT(connection, IsOk());
  ASSERT_THAT(connection->WaitForServer(), IsOk());
  int calls = 0;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(
      connection->Retry(
          {}, [&] { return ++calls < 4 ? absl::UnavailableError("draining") : absl::OkStatus(); }),
      IsOk());
  // 100 + 170 + 289 ms at most. Two steps an attempt would take 1.4 s at least.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(1300));
}

TEST(ConnectionTest, DoesNotRetryOtherErrors) {
  const auto connection = Connection::Open({});
  ASSERT_THAT(connection, IsOk());
  int calls = 0;
  const auto call = [&] {
    ++calls;
    return absl::ResourceExhaustedError("message larger than max");
  };
  EXPECT_THAT(connection->Retry({}, call),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("larger")));
  EXPECT_EQ(calls, 1);
}

TEST(RpcStatusTest, ReadsTheDelayTheServerNames) {
  const absl::Status status = FromGrpc(WithRetryInfo(grpc::StatusCode::RESOURCE_EXHAUSTED, 3));
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kResourceExhausted, "later"));
  EXPECT_EQ(RetryDelay(status), std::chrono::seconds(3));
  EXPECT_TRUE(IsRetriable(status));
}

TEST(RpcStatusTest, ADelayIsAtMostAMinute) {
  for (const int days : {1, 100'000}) {
    const auto status = FromGrpc(WithRetryInfo(grpc::StatusCode::UNAVAILABLE, days * 86'400LL));
    EXPECT_EQ(RetryDelay(status), std::chrono::minutes(1));
  }
  EXPECT_EQ(RetryDelay(FromGrpc(WithRetryInfo(grpc::StatusCode::UNAVAILABLE, -5))),
            std::chrono::seconds(0));
}

TEST(RpcStatusTest, ACallCancelledByAStoppingServerIsRetried) {
  EXPECT_TRUE(IsRetriable(FromGrpc({grpc::StatusCode::CANCELLED, "CANCELLED"})));
  EXPECT_FALSE(IsRetriable(absl::CancelledError("by a callback")));
}

TEST(RpcStatusTest, ExhaustedWithoutADelayIsNotRetried) {
  const absl::Status status = FromGrpc({grpc::StatusCode::RESOURCE_EXHAUSTED, "too large"});
  EXPECT_FALSE(RetryDelay(status).has_value());
  EXPECT_FALSE(IsRetriable(status));
}

}  // namespace
}  // namespace homing::client
