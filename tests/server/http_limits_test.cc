// HTTP clients that keep no rules.
#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <thread>
#include <utility>
#include <vector>

#include "server/access/certificate_folder.h"
#include "server/access/token_book.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class HttpLimitsTest : public ServerTest {
 protected:
  HttpLimitsTest() { options_.http = "127.0.0.1:0"; }
  httplib::Client Browser() { return httplib::Client("http://" + server_->metrics_address()); }
  void StartGuarded() {
    options_.tokens = folder_.File("tokens.toml");
    EXPECT_THAT(AddToken(options_.tokens, "robots/r", HashToken("secret-r")), IsOk());
    StartServer();
  }
};

// A client that keeps no rules.
class RawClient {
 public:
  RawClient(const std::string& server, const char* from)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in own = AddressOf(from, 0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)), 0);
    const auto port = static_cast<std::uint16_t>(std::stoi(server.substr(server.rfind(':') + 1)));
    sockaddr_in to = AddressOf("127.0.0.1", port);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  }
  RawClient(RawClient&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  ~RawClient() { ::close(socket_); }

  bool Send(const std::string& text) {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) > 0;
  }
  // What comes within `most`; empty: nothing, or the end.
  std::string Receive(std::chrono::milliseconds most) {
    pollfd file{socket_, POLLIN, 0};
    std::array<char, 4096> bytes{};
    if (::poll(&file, 1, static_cast<int>(most.count())) <= 0) return "";
    const ssize_t n = ::recv(socket_, bytes.data(), bytes.size(), 0);
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0))};
  }

 private:
  static sockaddr_in AddressOf(const char* ip, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    ::inet_pton(AF_INET, ip, &address.sin_addr);
    return address;
  }

  int socket_;
};

constexpr char kHealth[] = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";

// On the port of gRPC.
TEST_F(HttpLimitsTest, StreamsAndHeadersOfHttp2HaveAnnouncedLimits) {
  StartServer();
  RawClient client(server_->address(), "127.0.0.1");
  const std::string no_settings{"\0\0\0\x04\0\0\0\0\0", 9};
  ASSERT_TRUE(client.Send("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + no_settings));
  const std::string answer = client.Receive(std::chrono::seconds(5));
  // SETTINGS_MAX_CONCURRENT_STREAMS and SETTINGS_MAX_HEADER_LIST_SIZE.
  EXPECT_THAT(answer, HasSubstr(std::string{"\0\x03\0\0\x40\0", 6}));
  EXPECT_THAT(answer, HasSubstr(std::string{"\0\x06\0\0\x20\0", 6}));
}

TEST_F(HttpLimitsTest, HeadersWithoutEndAreCut) {
  StartServer();
  RawClient client(server_->metrics_address(), "127.0.0.1");
  ASSERT_TRUE(client.Send("GET /healthz HTTP/1.1\r\n"));
  const std::string line = "X: " + std::string(7000, 'x') + "\r\n";
  std::size_t sent = 0;
  constexpr std::size_t kFarTooMuch = 32 << 20;
  while (sent < kFarTooMuch && client.Send(line)) sent += line.size();
  EXPECT_LT(sent, kFarTooMuch);
}

TEST_F(HttpLimitsTest, ManySlowClientsOfOneAddressLeaveRoomForOthers) {
  StartServer();
  std::vector<RawClient> slow;
  for (int i = 0; i < 70; ++i) {
    slow.emplace_back(server_->metrics_address(), "127.0.0.3");
    slow.back().Send("GET /healthz HTTP/1.1\r\nX: ");
  }
  // One byte now and then: longer than any wait of the server, in all.
  int open = 70;
  for (int i = 0; i < 80 && open > 0; ++i) {
    open = 0;
    for (RawClient& client : slow) open += client.Send("x") ? 1 : 0;
    if (i % 5 == 0) {
      RawClient other(server_->metrics_address(), "127.0.0.2");
      ASSERT_TRUE(other.Send(kHealth));
      EXPECT_THAT(other.Receive(std::chrono::seconds(1)), HasSubstr("200 OK")) << i;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(open, 0);
}

TEST_F(HttpLimitsTest, IdleClientsOfManyAddressesLeaveRoomForOthers) {
  StartServer();
  std::vector<RawClient> idle;
  for (int i = 0; i < 600; ++i) {
    idle.emplace_back(server_->metrics_address(), ("127.0.1." + std::to_string(i / 40)).c_str());
  }
  RawClient other(server_->metrics_address(), "127.0.0.2");
  ASSERT_TRUE(other.Send(kHealth));
  EXPECT_THAT(other.Receive(std::chrono::seconds(3)), HasSubstr("200 OK"));
}

// A request may take five seconds.
TEST_F(HttpLimitsTest, HalfRequestsDoNotDelayTheEndOfTheServer) {
  options_.drain_ms = 100;
  StartServer();
  std::vector<RawClient> slow;
  for (int i = 0; i < 3; ++i) {
    slow.emplace_back(server_->metrics_address(), "127.0.0.1");
    ASSERT_TRUE(slow.back().Send("GET /healthz HTTP/1.1\r\nX: "));
  }
  RawClient idle(server_->metrics_address(), "127.0.0.1");
  ASSERT_TRUE(idle.Send(kHealth));
  ASSERT_THAT(idle.Receive(std::chrono::seconds(5)), HasSubstr("200 OK"));
  const auto begin = std::chrono::steady_clock::now();
  server_->Drain();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(3500));
}

// As after an error of accept that the library does not know.
TEST_F(HttpLimitsTest, AServerThatNoLongerListensEnds) {
  StartServer();
  ASSERT_EQ(Browser().Get("/healthz")->status, 200);
  const std::string address = server_->metrics_address();
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  for (int file = 0; file < 1000; ++file) {
    int listens = 0;
    socklen_t size = sizeof(listens);
    sockaddr_in name{};
    socklen_t name_size = sizeof(name);
    if (::getsockopt(file, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens != 0 &&
        ::getsockname(file, reinterpret_cast<sockaddr*>(&name), &name_size) == 0 &&
        ntohs(name.sin_port) == port) {
      ASSERT_EQ(::shutdown(file, SHUT_RDWR), 0);
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_FALSE(Browser().Get("/healthz"));
  const auto begin = std::chrono::steady_clock::now();
  server_->Drain();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST_F(HttpLimitsTest, AHandshakeHasAnEnd) {
  CertificateOrder order;
  order.folder = folder_.File("pki");
  EXPECT_THAT(MakeCertificates(order), IsOk());
  options_.tls_cert = folder_.File("pki/server.pem");
  options_.tls_key = folder_.File("pki/server.key");
  StartServer();
  RawClient client(server_->metrics_address(), "127.0.0.1");
  // The head of a record, whose content comes byte by byte.
  ASSERT_TRUE(client.Send(std::string{"\x16\x03\x01\x02\x00\x01", 6}));
  int sent = 0;
  while (sent < 200 && client.Send(std::string(1, '\0'))) {
    ++sent;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_LT(sent, 200);
}

TEST_F(HttpLimitsTest, RequestsInOnePieceAreAnsweredInOrder) {
  StartServer();
  RawClient client(server_->metrics_address(), "127.0.0.1");
  ASSERT_TRUE(client.Send(std::string(kHealth) + kHealth + kHealth));
  std::string answers;
  for (std::string more = "-"; !more.empty(); answers += more) {
    more = client.Receive(std::chrono::milliseconds(500));
  }
  std::size_t count = 0;
  for (auto at = answers.find("200 OK"); at != std::string::npos; ++count) {
    at = answers.find("200 OK", at + 1);
  }
  EXPECT_EQ(count, 3U);
}

TEST_F(HttpLimitsTest, PackedBodiesAreNotUnpacked) {
  StartGuarded();
  const std::string token = R"({"token":"secret-r"})";
  // As gzip without compression: a header, one stored block, a checksum.
  const auto size = static_cast<char>(token.size());
  std::string packed{"\x1f\x8b\x08\0\0\0\0\0\0\xff\x01", 11};
  packed += std::string{size, 0, static_cast<char>(~size), '\xff'} + token;
  const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(token.data()), token.size());
  for (int shift = 0; shift < 32; shift += 8) packed += static_cast<char>(sum >> shift & 0xff);
  packed += std::string{size, 0, 0, 0};
  auto browser = Browser();
  EXPECT_EQ(browser.Post("/api/v1/login", {{"Content-Encoding", "gzip"}}, packed, "")->status, 401);
  EXPECT_EQ(browser.Post("/api/v1/login", token, "")->status, 200);
}

// Of a part the library would send what lies behind the answer in memory.
TEST_F(HttpLimitsTest, AnAnswerEndsWhereItEnds) {
  StartServer();
  for (const char* range : {"bytes=0-1000", "bytes=2-100", "bytes=100-300", "bytes=0-0,0-500",
                            "bytes=99999999999999-100000000000000"}) {
    const auto answer = Browser().Get("/healthz", {{"Range", range}});
    ASSERT_TRUE(answer) << range;
    EXPECT_EQ(answer->status, 200) << range;
    EXPECT_EQ(answer->body, "ok\n") << range;
  }
}

// The library's patterns for forms take seconds of processor time for each request.
TEST_F(HttpLimitsTest, NoBodyIsReadAsAForm) {
  StartGuarded();
  for (const char* type :
       {"multipart/form-data; boundary=x", "application/x-www-form-urlencoded"}) {
    EXPECT_EQ(Browser().Post("/api/v1/login", R"({"token":"secret-r"})", type)->status, 200)
        << type;
  }
}

TEST_F(HttpLimitsTest, TheBodyOfARefusedRequestIsNoRequest) {
  StartServer();
  for (const char* first : {"POST /api/v1/login HTTP/1.1\r\nHost: evil.example\r\n",
                            "GET /api/v1/session HTTP/1.1\r\nHost: evil.example\r\n"}) {
    RawClient client(server_->metrics_address(), "127.0.0.1");
    const std::string inner = kHealth;
    ASSERT_TRUE(client.Send(first + ("Content-Length: " + std::to_string(inner.size())) +
                            "\r\n\r\n" + inner));
    std::string answers;
    for (std::string more = "-"; !more.empty(); answers += more) {
      more = client.Receive(std::chrono::milliseconds(500));
    }
    EXPECT_THAT(answers, AllOf(HasSubstr("403"), Not(HasSubstr("200 OK")))) << first;
  }
}

TEST_F(HttpLimitsTest, WhatFollowsARequestThatIsNotUnderstoodIsNoRequest) {
  StartServer();
  for (const std::string& first :
       {"GET /healthz HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n",
        std::string("nonsense\r\n\r\n"),
        std::string("POST /api/v1/login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n"
                    "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n"),
        std::string("POST /api/v1/login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n"
                    "Content-Length: 60\r\n\r\nabc"),
        std::string(
            "POST /api/v1/login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0,60\r\n\r\n"),
        std::string("POST /api/v1/login HTTP/1.1\r\nHost: localhost\r\nContent-Length: x\r\n\r\n"),
        std::string("POST /api/v1/login HTTP/1.1\r\nHost: localhost\r\n"
                    "Transfer-Encoding: chunked\r\n\r\n-1\r\n")}) {
    RawClient client(server_->metrics_address(), "127.0.0.1");
    ASSERT_TRUE(client.Send(first + kHealth));
    std::string answers;
    for (std::string more = "-"; !more.empty(); answers += more) {
      more = client.Receive(std::chrono::milliseconds(500));
    }
    EXPECT_THAT(answers, Not(HasSubstr("ok\n"))) << first.substr(0, 40);
  }
}

}  // namespace
}  // namespace homing::server
