#include "client/server_address.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "client/connection.h"
#include "tests/client/fake_journey_service.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

TEST(ServerAddressTest, IsHostAndPort) {
  for (const char* good : {"127.0.0.1:1", "base.local:50551", "[::1]:65535", "unix:/tmp/s"}) {
    EXPECT_THAT(CheckServerAddress(good), IsOk()) << good;
  }
  for (const char* bad :
       {"", "127.0.0.1", "base", "base:", ":50551", "base:0", "base:65536", "base:99999", "base:-1",
        "base:5x", "base:+5", "http://base:50551", "https://base", "::1:50551", "[::1]",
        "[::1]50551", "a b:5", "base:5/x"}) {
    EXPECT_THAT(CheckServerAddress(bad),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("HOST:PORT")))
        << bad;
  }
}

class ProxyTest : public ::testing::Test {
 protected:
  ProxyTest() { ::setenv("http_proxy", "http://127.0.0.1:9", 1); }
  ~ProxyTest() override { ::unsetenv("http_proxy"); }
};

TEST_F(ProxyTest, LocalAndPrivateAddressesNeedNone) {
  for (const char* address :
       {"127.0.0.1:1", "127.9.9.9:1", "10.1.2.3:1", "172.16.0.1:1", "172.31.9.9:1", "192.168.1.1:1",
        "169.254.1.1:1", "[::1]:1", "[fe80::1]:1", "[fd00::1]:1", "[::ffff:10.0.0.1]:1",
        "localhost:1", "base:1", "base.local:1", "unix:/tmp/s"}) {
    EXPECT_FALSE(MayUseProxy(address)) << address;
  }
  for (const char* address : {"8.8.8.8:1", "172.32.0.1:1", "11.0.0.1:1", "[2001:db8::1]:1"}) {
    EXPECT_TRUE(MayUseProxy(address)) << address;
  }
}

TEST_F(ProxyTest, AServerOfThisMachineIsReached) {
  FakeJourneyService service({});
  FakeServer server(&service);
  ConnectionOptions options;
  options.address = server.address();
  EXPECT_THAT(Connection::Open(options)->WaitForServer(), IsOk());
}

TEST_F(ProxyTest, IsNamedWhereItStandsBetween) {
  EXPECT_THAT(
      ExplainUnreachable("8.8.8.8:50551", false),
      StatusIs(absl::StatusCode::kUnavailable, HasSubstr("http_proxy (http://127.0.0.1:9)")));
}

TEST(UnreachableTest, ReasonsDiffer) {
  EXPECT_THAT(ExplainUnreachable("127.0.0.1:1", false),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("Connection refused")));
  EXPECT_THAT(ExplainUnreachable("no-such-host.invalid:1", false),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("cannot be resolved")));
  FakeJourneyService service({});
  FakeServer server(&service);
  EXPECT_THAT(ExplainUnreachable(server.address(), true),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("speaks no TLS")));
}

}  // namespace
}  // namespace homing::client
