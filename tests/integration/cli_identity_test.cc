// Certificates and tokens from the command that makes them to the robot that uses them.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kSource[] = "sim:street,length=4";

std::string Read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class CliIdentityTest : public CliTest {
 protected:
  void SetUp() override {
    const Ran ran = Run({HOMING_SERVER_PROGRAM, "certs", "--out", Path("pki"), "--robot", "r1",
                         "--robot", "r2", "--operator", "anna"});
    ASSERT_EQ(ran.code, 0) << ran.errors;
  }
  std::vector<std::string> Tls() const {
    return {"--tls-cert",      Path("pki/server.pem"), "--tls-key",     Path("pki/server.key"),
            "--tls-client-ca", Path("pki/ca.pem"),     "--tls-crl-dir", Path("pki/crl")};
  }
  Ran HomingAs(const std::string& identity, std::vector<std::string> arguments) const {
    for (const std::string& more : {std::string("--tls-ca"), Path("pki/ca.pem"),
                                    std::string("--tls-cert"), Path("pki/" + identity + ".pem"),
                                    std::string("--tls-key"), Path("pki/" + identity + ".key")}) {
      arguments.push_back(more);
    }
    return Homing(arguments);
  }
  static std::vector<std::string> Record(const std::string& journey) {
    return {"record", "--journey", journey, "--left", kSource, "--send", "flow"};
  }
};

TEST_F(CliIdentityTest, ARobotRecordsItsOwnJourneysAndNoOthers) {
  StartServer("homing.db", Tls());
  const Ran own = HomingAs("robots/r1", Record("robots/r1/journeys/out"));
  EXPECT_EQ(own.code, 0) << own.errors;
  const Ran foreign = HomingAs("robots/r2", Record("robots/r1/journeys/out"));
  EXPECT_EQ(foreign.code, 1);
  EXPECT_THAT(foreign.errors, AllOf(HasSubstr("PERMISSION_DENIED"), HasSubstr("operator can")));
  const Ran list = HomingAs("operators/anna", {"journeys", "list"});
  EXPECT_EQ(list.code, 0) << list.errors;
  EXPECT_THAT(list.lines, ::testing::Contains(HasSubstr("robots/r1/journeys/out")));
}

TEST_F(CliIdentityTest, AClientWithoutTlsGetsAHint) {
  StartServer("homing.db", Tls());
  const Ran plain = Homing({"journeys", "list", "--retry-seconds", "0"});
  EXPECT_EQ(plain.code, 3);
  EXPECT_THAT(plain.errors, HasSubstr("TLS"));
  EXPECT_EQ(
      Run({HOMING_SERVER_PROGRAM, "healthcheck", "--server", address_, "--ca", Path("pki/ca.pem"),
           "--cert", Path("pki/robots/r1.pem"), "--key", Path("pki/robots/r1.key")})
          .code,
      0);
}

TEST_F(CliIdentityTest, ATokenDoesWhereThereIsNoCertificateAndIsWrittenNowhere) {
  const Ran made = Run({HOMING_SERVER_PROGRAM, "token", "robots/r3", "--tokens",
                        Path("tokens.toml"), "--out", Path("r3.token")});
  ASSERT_EQ(made.code, 0) << made.errors;
  std::string token = Read(Path("r3.token"));
  ASSERT_GT(token.size(), 40U);
  token.pop_back();
  StartServer("homing.db", {"--tokens", Path("tokens.toml")});
  auto arguments = Record("robots/r3/journeys/out");
  const Ran nobody = Homing(arguments);
  EXPECT_EQ(nobody.code, 1);
  EXPECT_THAT(nobody.errors, AllOf(HasSubstr("UNAUTHENTICATED"), HasSubstr("--token-file")));
  arguments.insert(arguments.end(), {"--token-file", Path("r3.token")});
  const Ran own = Homing(arguments);
  EXPECT_EQ(own.code, 0) << own.errors;
  std::ofstream(Path("bad.token")) << token << "x";
  const Ran stranger = Homing({"journeys", "list", "--token-file", Path("bad.token")});
  EXPECT_EQ(stranger.code, 1);
  for (const std::string& text : {made.errors, own.errors, stranger.errors, server_->Stderr(),
                                  Read(Path("tokens.toml")), made.lines.front()}) {
    EXPECT_THAT(text, Not(HasSubstr(token)));
  }
}

TEST_F(CliIdentityTest, WrongOrdersAreRefused) {
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "certs"}).code, 2);
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "certs", "--out", Path("pki"), "--robot", "a/b"}).code, 1);
  EXPECT_EQ(
      Run({HOMING_SERVER_PROGRAM, "certs", "--out", Path("pki"), "--revoke", "robots/r9"}).code, 1);
  const Ran missing = Run({HOMING_SERVER_PROGRAM, "token", "robots/r", "--out", Path("t")});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.errors, HasSubstr("tokens: must name the file"));
}

}  // namespace
}  // namespace homing
