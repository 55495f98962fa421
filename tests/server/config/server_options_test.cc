#include "server/config/server_options.h"

#include <cstdlib>
#include <fstream>
#include <vector>

#include "server/config/option_table.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

ServerCommand Parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "homing-server");
  return ParseCommandLine(static_cast<int>(arguments.size()), arguments.data());
}

class ServerOptionsTest : public ::testing::Test {
 protected:
  ~ServerOptionsTest() override {
    unsetenv("HOMING_LISTEN");
    unsetenv("HOMING_WORKERS");
    unsetenv("HOMING_NO_REFLECTION");
  }
  std::string WriteFile(const std::string& text) {
    const std::string path = folder_.File("server.toml");
    std::ofstream(path) << text;
    return path;
  }
  TemporaryFolder folder_;
};

TEST_F(ServerOptionsTest, WithoutArgumentsItListensOnLoopback) {
  const ServerCommand command = Parse({});
  EXPECT_EQ(command.action, ServerCommand::Action::kServe);
  EXPECT_EQ(command.options.listen, "127.0.0.1:50551");
  EXPECT_EQ(command.options.database, "sqlite:homing.db");
  EXPECT_EQ(command.options.max_message, 16 << 20);
  EXPECT_FALSE(command.options.no_reflection);
}

TEST_F(ServerOptionsTest, FlagBeatsVariableBeatsFile) {
  const std::string file = WriteFile(
      "listen = \"127.0.0.1:1\"\nworkers = 1\nmax-pixels = 1000\nmax-message = \"1MiB\"\n"
      "no-reflection = true\ninsecure = false\n");
  setenv("HOMING_LISTEN", "127.0.0.1:2", 1);
  setenv("HOMING_WORKERS", "2", 1);
  const ServerCommand command = Parse({"--config", file.c_str(), "--listen", "127.0.0.1:3"});
  ASSERT_EQ(command.action, ServerCommand::Action::kServe);
  EXPECT_EQ(command.options.listen, "127.0.0.1:3");
  EXPECT_EQ(command.options.workers, 2);
  EXPECT_EQ(command.options.max_pixels, 1000);
  EXPECT_EQ(command.options.max_message, 1 << 20);
  EXPECT_TRUE(command.options.no_reflection);
  EXPECT_FALSE(command.options.insecure);
}

TEST_F(ServerOptionsTest, AFlagMayBeSetByAVariable) {
  setenv("HOMING_NO_REFLECTION", "true", 1);
  EXPECT_TRUE(Parse({}).options.no_reflection);
}

TEST_F(ServerOptionsTest, WrongUsageExitsWithTwo) {
  EXPECT_EQ(Parse({"--nonsense"}).exit_code, 2);
  EXPECT_EQ(Parse({"--workers", "many"}).exit_code, 2);
  EXPECT_EQ(Parse({"--config", "/nowhere.toml"}).exit_code, 2);
  // A folder would be read as an empty file: no TLS, no tokens.
  EXPECT_EQ(Parse({"--config", "/tmp"}).exit_code, 2);
  EXPECT_EQ(Parse({"--config", WriteFile("colour = 1\n").c_str()}).exit_code, 2);
  EXPECT_EQ(Parse({"--config", WriteFile("listen = [1]\n").c_str()}).exit_code, 2);
  EXPECT_EQ(Parse({"--config", WriteFile("listen = \n").c_str()}).exit_code, 2);
  EXPECT_EQ(Parse({"--config", WriteFile("workers = \"x\"\n").c_str()}).exit_code, 2);
}

TEST_F(ServerOptionsTest, AnUnsetVariableOfAScriptTurnsNoTokensOff) {
  for (const char* flag : {"--tokens", "--roles", "--tls-client-ca", "--tls-crl-dir"}) {
    EXPECT_EQ(Parse({flag, ""}).exit_code, 2) << flag;
  }
  // What --check-config prints is a valid file.
  const ServerOptions defaults;
  const ServerCommand read = Parse({"--config", WriteFile(ToToml(defaults)).c_str()});
  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.options.tokens, "");
}

TEST_F(ServerOptionsTest, KnowsWhereEverybodyMayDoEverything) {
  ServerOptions options;
  EXPECT_FALSE(IsOpenToAll(options));
  options.listen = "0.0.0.0:50551";
  EXPECT_TRUE(IsOpenToAll(options));
  options.tokens = "tokens";
  EXPECT_FALSE(IsOpenToAll(options));
  options.tokens = "";
  options.tls_client_ca = "ca.pem";
  EXPECT_FALSE(IsOpenToAll(options));
}

TEST_F(ServerOptionsTest, TheLogIsTextOrJson) {
  ServerOptions options;
  for (const char* format : {"text", "json"}) {
    options.log_format = format;
    EXPECT_THAT(Validate(options), IsOk()) << format;
  }
  options.log_format = "xml";
  EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                          HasSubstr("log-format: \"xml\" must be text or json")));
}

TEST_F(ServerOptionsTest, HelpAndVersionExitWithZero) {
  EXPECT_EQ(Parse({"--help"}).action, ServerCommand::Action::kExit);
  EXPECT_EQ(Parse({"--help"}).exit_code, 0);
  EXPECT_EQ(Parse({"--version"}).exit_code, 0);
}

TEST_F(ServerOptionsTest, HelpShowsDefaults) {
  testing::internal::CaptureStdout();
  Parse({"--help"});
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_THAT(help, testing::AllOf(HasSubstr("--listen TEXT=127.0.0.1:50551 "),
                                   HasSubstr("--http TEXT=127.0.0.1:8080 "),
                                   HasSubstr("--reload-s INT=5 "), HasSubstr("=16MiB "),
                                   HasSubstr("=1GiB "), HasSubstr("--tls-cert TEXT ")));
}

TEST_F(ServerOptionsTest, HealthIsAskedWhereTheServerListensUnlessSaidOtherwise) {
  ServerCommand command = Parse({"healthcheck", "--listen", "127.0.0.1:7"});
  EXPECT_EQ(command.action, ServerCommand::Action::kHealthCheck);
  EXPECT_EQ(command.health_server, "127.0.0.1:7");
  command = Parse({"healthcheck", "--server", "127.0.0.1:8"});
  EXPECT_EQ(command.health_server, "127.0.0.1:8");
}

TEST_F(ServerOptionsTest, OffLoopbackNeedsTlsOrTheFlagThatSaysSo) {
  ServerOptions options;
  for (const char* address : {"127.0.0.1:0", "localhost:1", "[::1]:1", "127.8.0.1:0"}) {
    options.listen = address;
    EXPECT_THAT(Validate(options), IsOk()) << address;
  }
  for (const char* address :
       {"0.0.0.0:0", "[::]:1", "10.0.0.1:1", "example.org:1", "127.example.org:1"}) {
    options.listen = address;
    EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                            HasSubstr("loopback address without TLS")))
        << address;
  }
  options.insecure = true;
  EXPECT_THAT(Validate(options), IsOk());
}

TEST_F(ServerOptionsTest, HealthOfTheSameEnvironmentTrustsTheServersCertificate) {
  ServerCommand command = Parse({"healthcheck", "--tls-cert", "server.pem", "--tls-key", "k"});
  EXPECT_EQ(command.health_trusted, "server.pem");
  EXPECT_EQ(command.health_cert, "");
  command = Parse({"healthcheck", "--tls-cert", "server.pem", "--tls-key", "k", "--ca", "ca.pem"});
  EXPECT_EQ(command.health_trusted, "");
  command = Parse({"healthcheck", "--tls-cert", "server.pem", "--server", "127.0.0.1:8"});
  EXPECT_EQ(command.health_trusted, "");
}

TEST_F(ServerOptionsTest, AddressesHaveAValidPort) {
  for (const char* address : {"127.0.0.1", "127.0.0.1:", "127.0.0.1:99999", "127.0.0.1:-1", ":1",
                              "localhost:http", "http://127.0.0.1:1", "::1:1"}) {
    ServerOptions options;
    options.listen = address;
    EXPECT_THAT(Validate(options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("listen: ")))
        << address;
    options = ServerOptions();
    options.http = address;
    EXPECT_THAT(Validate(options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("http: ")))
        << address;
  }
}

TEST_F(ServerOptionsTest, WhatIsAcknowledgedIsKeptInAFile) {
  ServerOptions options;
  options.database = "sqlite::memory:";
  EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                          HasSubstr("must be a file; what is in memory ends")));
}

TEST_F(ServerOptionsTest, ItsOutputIsAFileWithTheSameOptions) {
  ServerOptions options;
  options.listen = "127.0.0.1:9";
  options.workers = 3;
  options.no_reflection = true;
  options.database = "sqlite:with \"quotes\".db";
  const std::string file = WriteFile(ToToml(options));
  EXPECT_EQ(ToToml(Parse({"--config", file.c_str()}).options), ToToml(options));
}

TEST_F(ServerOptionsTest, MetricsAreOnLoopbackUnlessSaidOtherwise) {
  EXPECT_EQ(Parse({}).options.http, "127.0.0.1:8080");
  EXPECT_TRUE(Parse({}).options.http_optional);
  const std::string file = WriteFile("http = \"off\"\nmax-robot-bytes = \"2KiB\"\n");
  EXPECT_FALSE(HasHttp(Parse({"--config", file.c_str()}).options));
  EXPECT_EQ(Parse({"--config", file.c_str()}).options.limits.max_robot_bytes, 2048);
  EXPECT_FALSE(HasHttp(Parse({"--http", "off"}).options));
  ServerOptions options = Parse({"--http", "0.0.0.0:1"}).options;
  EXPECT_FALSE(options.http_optional);
  EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("http: ")));
  options.insecure = true;
  EXPECT_THAT(Validate(options), IsOk());
}

TEST_F(ServerOptionsTest, SubcommandsKnowTheirOrders) {
  ServerCommand command = Parse({"certs", "--out", "pki", "--robot", "a", "--robot", "b"});
  EXPECT_EQ(command.action, ServerCommand::Action::kCerts);
  EXPECT_EQ(command.certificates.robots.size(), 2u);
  command = Parse({"token", "robots/a", "--out", "t", "--tokens", "f"});
  EXPECT_EQ(command.action, ServerCommand::Action::kToken);
  EXPECT_EQ(command.token.identity, "robots/a");
  EXPECT_EQ(command.options.tokens, "f");
}

TEST_F(ServerOptionsTest, LimitsAreChecked) {
  ServerOptions options;
  options.limits.max_robot_rate = -1;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("max-robot-rate")));
  options = {};
  options.tls_crl_dir = "crl";
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-client-ca")));
  // A camera's flow is never taken with more than 100,000 vectors.
  options = {};
  options.max_vectors = 100'001;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("max-vectors")));
  options = {};
  options.max_message = 1;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("max-message")));
  options = {};
  options.tls_cert = "cert.pem";
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-key")));
}

}  // namespace
}  // namespace homing::server
