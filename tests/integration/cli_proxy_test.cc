// nginx between client and server, with its default limits: a recording is broken off after each
// MiB and goes on.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <thread>
#include <utility>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

constexpr char kNginx[] = "/usr/sbin/nginx";

int FreePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof(address);
  ::bind(socket, reinterpret_cast<sockaddr*>(&address), length);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length);
  ::close(socket);
  return ntohs(address.sin_port);
}

class CliProxyTest : public CliTest {
 protected:
  void SetUp() override {
    if (::access(kNginx, X_OK) != 0) GTEST_SKIP() << "SKIPPED: nginx is not installed";
    StartServer();
    const std::string port = std::to_string(FreePort());
    std::ofstream(Path("nginx.conf"))
        << "daemon off; pid " << Path("pid") << "; error_log " << Path("errors") << ";\n"
        << "events { worker_connections 64; }\n"
        << "http { access_log off; client_body_temp_path " << Path("body") << "; proxy_temp_path "
        << Path("proxy") << "; fastcgi_temp_path " << Path("fastcgi") << "; uwsgi_temp_path "
        << Path("uwsgi") << "; scgi_temp_path " << Path("scgi") << ";\n"
        << "  server { listen 127.0.0.1:" << port << " http2; location / { grpc_pass grpc://"
        << address_ << "; } } }\n";
    nginx_ = std::make_unique<Program>(
        std::vector<std::string>{kNginx, "-e", Path("errors"), "-c", Path("nginx.conf")});
    server_address_ = address_;
    address_ = "127.0.0.1:" + port;
    for (int i = 0; i < 50 && Homing({"journeys", "list"}).code != 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  void TearDown() override {
    if (nginx_) {
      nginx_->Signal(SIGTERM);
      nginx_->Wait();
    }
    CliTest::TearDown();
  }

  std::unique_ptr<Program> nginx_;
  std::string server_address_;
};

TEST_F(CliProxyTest, ARecordingThatIsBrokenOffGoesOnToItsEnd) {
  const std::string scene = "sim:street,length=12";
  const Ran ran = Homing({"record", "--journey", kJourney, "--left", scene, "--right", scene});
  EXPECT_EQ(ran.code, 0) << ran.errors;
  EXPECT_THAT(ran.errors, HasSubstr("link restored"));
  const std::string through = Export(kJourney);
  address_ = server_address_;
  const std::string straight = "robots/a/journeys/straight";
  ASSERT_EQ(Homing({"record", "--journey", straight, "--left", scene, "--right", scene}).code, 0);
  EXPECT_TRUE(Export(straight) == through) << "the maps differ";
}

// The last answered observations, which are sent again after a broken link, alone are more than a
// MiB.
TEST_F(CliProxyTest, LocalisingGoesOnToItsEnd) {
  const std::string scene = "sim:street,length=8";
  const std::string proxy = std::exchange(address_, server_address_);
  ASSERT_EQ(Homing({"record", "--journey", kJourney, "--left", scene, "--right", scene}).code, 0);
  address_ = proxy;
  const std::string home = scene + ",travel=return";
  const Ran ran =
      Homing({"--json", "localize", "--journey", kJourney, "--left", home, "--right", home});
  EXPECT_EQ(ran.code, 0) << ran.errors;
  EXPECT_THAT(ran.errors, HasSubstr("link lost"));
  EXPECT_GE(ran.lines.size(), 30U);
}

}  // namespace
}  // namespace homing
