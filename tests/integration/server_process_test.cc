// homing-server as a process: how it starts, answers for its health, and stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/program.h"
#include "tests/support/temporary_folder.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

class ServerProcessTest : public ::testing::Test {
 protected:
  std::vector<std::string> Command(const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {HOMING_SERVER_PROGRAM, "--listen", "127.0.0.1:0",
                                        "--database", folder_.Database()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  }
  // The address that the server says it listens on.
  static std::string AddressOf(Program* server) {
    const std::string line = server->ReadLine().value_or("");
    EXPECT_EQ(line.rfind("listening on 127.0.0.1:", 0), 0u) << line << server->Stderr();
    return line.substr(line.rfind(' ') + 1);
  }
  static int Run(const std::vector<std::string>& command, std::string* errors = nullptr) {
    Program program(command);
    const int code = program.Wait();
    if (errors != nullptr) {
      *errors = program.Stderr();
    }
    return code;
  }

  TemporaryFolder folder_;
};

TEST_F(ServerProcessTest, ItSaysWhereItListensIsHealthyAndStopsCleanly) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Program server(Command({}));
    const std::string address = AddressOf(&server);
    EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "healthcheck", "--server", address}), 0);
    server.Signal(signal);
    EXPECT_EQ(server.Wait(), 0) << server.Stderr();
    EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "healthcheck", "--server", address}), 1);
    EXPECT_FALSE(std::filesystem::exists(folder_.File("homing.db-wal")));
  }
}

TEST_F(ServerProcessTest, ItsHealthIsAskedWithoutAProxy) {
  Program server(Command({}));
  const std::string address = AddressOf(&server);
  for (const std::string name : {"http_proxy", "https_proxy", "grpc_proxy"}) {
    EXPECT_EQ(Run({"/usr/bin/env", name + "=http://127.0.0.1:9", HOMING_SERVER_PROGRAM,
                   "healthcheck", "--server", address}),
              0)
        << name;
  }
}

TEST_F(ServerProcessTest, ItOpensAsManyConnectionsAsTheSystemAllows) {
  std::vector<std::string> command = {"/bin/sh", "-c", "ulimit -S -n 64 && exec \"$0\" \"$@\""};
  const std::vector<std::string> server_command = Command({});
  command.insert(command.end(), server_command.begin(), server_command.end());
  Program server(command);
  AddressOf(&server);
  rlimit files{};
  ASSERT_EQ(prlimit(server.pid(), RLIMIT_NOFILE, nullptr, &files), 0);
  EXPECT_EQ(files.rlim_cur, files.rlim_max);
  EXPECT_GT(files.rlim_max, 64u);
}

// Connections that send nothing, or a little.
class Sockets {
 public:
  ~Sockets() {
    for (const int socket : sockets_) ::close(socket);
  }
  void Open(const std::string& address, const std::string& text = "") {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port =
        htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    ::connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof(to));
    ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    sockets_.push_back(socket);
  }
  // The first bytes of the answer on the last one, within ten seconds.
  std::string Answer() const {
    pollfd poll{sockets_.back(), POLLIN, 0};
    std::array<char, 15> bytes{};
    if (::poll(&poll, 1, 10'000) <= 0) return "";
    const auto size = ::recv(sockets_.back(), bytes.data(), bytes.size(), 0);
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
  }

 private:
  std::vector<int> sockets_;
};

TEST_F(ServerProcessTest, AMomentWithoutFileDescriptorsIsSurvived) {
  std::vector<std::string> command = {"/bin/sh", "-c", "ulimit -n 64 && exec \"$0\" \"$@\""};
  const std::vector<std::string> server_command = Command({"--http", "off"});
  command.insert(command.end(), server_command.begin(), server_command.end());
  Program server(command);
  const std::string address = AddressOf(&server);
  {
    Sockets flood;
    for (int i = 0; i < 100; ++i) flood.Open(address);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  int code = 1;
  for (int i = 0; i < 20 && code != 0; ++i) {
    code = Run({HOMING_SERVER_PROGRAM, "healthcheck", "--server", address});
  }
  EXPECT_EQ(code, 0) << server.Stderr();
}

TEST_F(ServerProcessTest, SlowClientsDoNotStopTheMetrics) {
  Program server(Command({"--http", "127.0.0.1:0"}));
  AddressOf(&server);
  const std::string line = server.ReadLine().value_or("");
  const std::string address = line.substr(0, line.rfind('/'));
  Sockets slow;
  for (int i = 0; i < 12; ++i) slow.Open(address, "GET /metrics HTTP/1.1\r\nX-a: ");
  Sockets quick;
  quick.Open(address, "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(quick.Answer(), "HTTP/1.1 200 OK");
}

TEST_F(ServerProcessTest, AServerOnATakenAddressSaysSoAndEnds) {
  Program server(Command({}));
  const std::string address = AddressOf(&server);
  std::string errors;
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "--listen", address, "--database",
                 "sqlite:" + folder_.File("other.db")},
                &errors),
            1);
  EXPECT_THAT(errors, HasSubstr("in use"));
}

TEST_F(ServerProcessTest, OffLoopbackWithoutTlsItDoesNotStart) {
  std::string errors;
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "--listen", "0.0.0.0:0", "--database", folder_.Database()},
                &errors),
            1);
  EXPECT_THAT(errors, HasSubstr("loopback address without TLS"));
}

TEST_F(ServerProcessTest, CheckConfigPrintsTheValuesAndChangesNothing) {
  Program check(Command({"--check-config", "--max-message", "1MiB"}));
  EXPECT_EQ(check.Wait(), 0);
  EXPECT_THAT(check.lines(), ::testing::Contains("max-message = 1048576"));
  EXPECT_FALSE(std::filesystem::exists(folder_.File("homing.db")));
  EXPECT_EQ(Run(Command({"--check-config", "--workers", "-1"})), 1);
}

TEST_F(ServerProcessTest, OverTlsItsHealthIsAskedWithItsCa) {
  const std::string key = folder_.File("key.pem");
  const std::string cert = folder_.File("cert.pem");
  const std::string make =
      "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1"
      " -nodes -days 2 -subj /CN=localhost -addext subjectAltName=IP:127.0.0.1"
      " -keyout " +
      key + " -out " + cert + " 2>/dev/null";
  if (std::system(make.c_str()) != 0) {
    GTEST_SKIP() << "SKIPPED: openssl is not installed, so there is no certificate to try";
  }
  Program server(Command({"--tls-cert", cert, "--tls-key", key}));
  const std::string address = AddressOf(&server);
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "healthcheck", "--server", address, "--ca", cert}), 0);
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "healthcheck", "--server", address}), 1);
  std::string errors;
  EXPECT_EQ(Run({HOMING_SERVER_PROGRAM, "--listen", "127.0.0.1:0", "--database",
                 "sqlite:" + folder_.File("other.db"), "--tls-cert", cert, "--tls-key",
                 folder_.File("none.pem")},
                &errors),
            1);
  EXPECT_THAT(errors, HasSubstr("tls-key"));
}

}  // namespace
}  // namespace homing
