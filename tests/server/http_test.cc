// The HTTP side over a real socket: logins, roles, and the checks of where a request comes from.
#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "server/access/token_book.h"
#include "server/http/login_limit.h"
#include "server/http/request_guard.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class HttpTest : public ServerTest {
 protected:
  HttpTest() { options_.http = "127.0.0.1:0"; }
  httplib::Client Browser() { return httplib::Client("http://" + server_->metrics_address()); }
  void StartGuarded() {
    options_.tokens = folder_.File("tokens.toml");
    EXPECT_THAT(AddToken(options_.tokens, "operators/o", HashToken("secret-o")), IsOk());
    EXPECT_THAT(AddToken(options_.tokens, "robots/r", HashToken("secret-r")), IsOk());
    StartServer();
  }
  // The session of a cookie.
  nlohmann::json Session(const httplib::Headers& headers) {
    const auto answer = Browser().Get("/api/v1/session", headers);
    return nlohmann::json::parse(answer->body);
  }
  static std::string CookieIn(const httplib::Result& answer) {
    const std::string header = answer->get_header_value("Set-Cookie");
    return header.substr(0, header.find(';'));
  }
};

TEST_F(HttpTest, WithoutCredentialsTheConsoleIsOpenOnlyUnderAKnownName) {
  StartServer();
  auto browser = Browser();
  EXPECT_EQ(browser.Get("/")->status, 200);
  EXPECT_THAT(browser.Get("/")->get_header_value("Content-Security-Policy"),
              HasSubstr("script-src 'self'"));
  const nlohmann::json session = Session({});
  EXPECT_EQ(session["role"], "admin");
  EXPECT_EQ(browser.Get("/api/v1/session", {{"Host", "evil.example"}})->status, 403);
  EXPECT_EQ(browser.Get("/api/v1/session", {{"Origin", "http://evil.example"}})->status, 403);
  EXPECT_EQ(browser.Get("/events", {{"Sec-Fetch-Site", "cross-site"}})->status, 403);
  EXPECT_EQ(browser.Get("/healthz", {{"Host", "probe.example"}})->body, "ok\n");
  const std::string csrf = session["csrf"];
  const char* list = "/api/v1/FleetService/ListRobots";
  EXPECT_EQ(browser.Post(list, {}, "{}", "application/json")->status, 403);
  EXPECT_EQ(browser.Post(list, {{"X-CSRF-Token", csrf}}, "{}", "application/json")->status, 200);
  EXPECT_EQ(browser.Post(list, {{"X-CSRF-Token", csrf}}, "nonsense", "")->status, 400);
  const char* stream = "/api/v1/HomingService/Localize";
  EXPECT_EQ(browser.Post(stream, {{"X-CSRF-Token", csrf}}, "{}", "")->status, 404);
}

TEST_F(HttpTest, TheApiIsThatOfGrpc) {
  StartServer();
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 5);
  const httplib::Headers headers = {{"X-CSRF-Token", Session({})["csrf"].get<std::string>()}};
  auto browser = Browser();
  const auto answer = browser.Post("/api/v1/JourneyService/GetJourney", headers,
                                   R"({"name":"robots/r/journeys/out"})", "application/json");
  EXPECT_EQ(nlohmann::json::parse(answer->body)["stepCount"], "5");
  EXPECT_FALSE(answer->has_header("Content-Encoding"));
  EXPECT_EQ(browser
                .Post("/api/v1/JourneyService/GetJourney", headers,
                      R"({"name":"robots/r/journeys/none"})", "application/json")
                ->status,
            404);
}

TEST_F(HttpTest, ATokenOpensASessionWithItsRole) {
  StartGuarded();
  auto browser = Browser();
  EXPECT_EQ(browser.Get("/metrics")->status, 200);
  EXPECT_EQ(browser.Get("/api/v1/session")->status, 401);
  EXPECT_EQ(browser.Get("/events")->status, 401);
  EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"guess"})", "")->status, 401);
  EXPECT_EQ(browser.Post("/api/v1/login", "nonsense", "")->status, 401);
  const auto login = browser.Post("/api/v1/login", R"({"token":"secret-r"})", "");
  EXPECT_THAT(login->get_header_value("Set-Cookie"), HasSubstr("HttpOnly; SameSite=Strict"));
  EXPECT_THAT(login->get_header_value("Set-Cookie"), Not(HasSubstr("secret-r")));
  const std::string cookie = CookieIn(login);
  const nlohmann::json session = Session({{"Cookie", cookie}});
  EXPECT_EQ(session["identity"], "robots/r");
  const httplib::Headers headers = {{"Cookie", cookie},
                                    {"X-CSRF-Token", session["csrf"].get<std::string>()}};
  const auto create = [&](const char* parent) {
    return browser
        .Post("/api/v1/JourneyService/CreateJourney", headers,
              nlohmann::json{{"parent", parent}, {"journeyId", "j"}}.dump(), "")
        ->status;
  };
  EXPECT_EQ(create("robots/r"), 200);
  EXPECT_EQ(create("robots/other"), 403);
  EXPECT_EQ(browser.Post("/api/v1/logout", headers, "", "")->status, 200);
  EXPECT_EQ(create("robots/r"), 401);
}

TEST_F(HttpTest, ALinkLogsInOnce) {
  StartGuarded();
  const std::string link = server_->console_link(true);
  EXPECT_EQ(server_->console_link(false).find("once="), std::string::npos);
  auto browser = Browser();
  const std::string path = link.substr(link.find("/login"));
  const auto first = browser.Get(path);
  EXPECT_EQ(first->status, 303);
  EXPECT_EQ(Session({{"Cookie", CookieIn(first)}})["role"], "operator");
  EXPECT_FALSE(browser.Get(path)->has_header("Set-Cookie"));
}

TEST_F(HttpTest, AProxyNamesTheUserOnlyIfItsHeaderIsSetUp) {
  StartGuarded();
  EXPECT_EQ(Browser().Get("/api/v1/session", {{"X-Forwarded-User", "anna"}})->status, 401);
  options_.http_user_header = "X-Forwarded-User";
  StartServer();
  EXPECT_EQ(Session({{"X-Forwarded-User", "anna"}})["identity"], "operators/anna");
  EXPECT_EQ(Browser().Get("/api/v1/session", {{"X-Forwarded-User", "an/na"}})->status, 400);
}

TEST(RequestGuardTest, HostsOriginsAndCookies) {
  EXPECT_TRUE(IsKnownHost("127.0.0.1:8080", ""));
  EXPECT_TRUE(IsKnownHost("[::1]:8080", ""));
  EXPECT_TRUE(IsKnownHost("LOCALHOST", ""));
  EXPECT_TRUE(IsKnownHost("base.example:8080", "other, base.example"));
  EXPECT_FALSE(IsKnownHost("base.example", ""));
  EXPECT_FALSE(IsKnownHost("127.0.0.1.evil.example", ""));
  EXPECT_FALSE(IsKnownHost("", ""));
  EXPECT_TRUE(IsSameOrigin("", "a:1"));
  EXPECT_TRUE(IsSameOrigin("https://a:1", "a:1"));
  EXPECT_FALSE(IsSameOrigin("null", "a:1"));
  EXPECT_FALSE(IsSameOrigin("http://a:2", "a:1"));
  EXPECT_EQ(CookieOf("x=1; homing_session=abc", "homing_session"), "abc");
  EXPECT_EQ(CookieOf("xhoming_session=abc", "homing_session"), "");
  EXPECT_TRUE(IsTraceParent("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"));
  EXPECT_FALSE(IsTraceParent("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-0\n"));
}

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

TEST_F(HttpTest, HeadersWithoutEndAreCut) {
  StartServer();
  RawClient client(server_->metrics_address(), "127.0.0.1");
  ASSERT_TRUE(client.Send("GET /healthz HTTP/1.1\r\n"));
  const std::string line = "X: " + std::string(7000, 'x') + "\r\n";
  std::size_t sent = 0;
  constexpr std::size_t kFarTooMuch = 32 << 20;
  while (sent < kFarTooMuch && client.Send(line)) sent += line.size();
  EXPECT_LT(sent, kFarTooMuch);
}

TEST_F(HttpTest, ManySlowClientsOfOneAddressLeaveRoomForOthers) {
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

TEST_F(HttpTest, RequestsInOnePieceAreAnsweredInOrder) {
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

TEST_F(HttpTest, GuessesOfOneAddressHaveToWait) {
  StartGuarded();
  auto browser = Browser();
  for (int i = 0; i < LoginLimit::kMostFailures; ++i) {
    EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"guess"})", "")->status, 401);
  }
  EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"secret-r"})", "")->status, 429);
  EXPECT_EQ(browser.Get("/login?once=guess")->get_header_value("Location"), "/#/login?link=used");
  EXPECT_EQ(browser.Get("/healthz")->status, 200);
}

TEST(LoginLimitTest, AnAddressMayTryAgainAMinuteLater) {
  LoginLimit limit;
  const LoginLimit::Time now;
  for (int i = 0; i < LoginLimit::kMostFailures; ++i) {
    EXPECT_TRUE(limit.MayTry("1.2.3.4", now));
    limit.NoteFailure("1.2.3.4", now);
  }
  EXPECT_FALSE(limit.MayTry("1.2.3.4", now));
  EXPECT_TRUE(limit.MayTry("1.2.3.5", now));
  EXPECT_TRUE(limit.MayTry("1.2.3.4", now + LoginLimit::kPeriod));
  for (int i = 0; i < 20'000; ++i) limit.NoteFailure(std::to_string(i), now);
  EXPECT_FALSE(limit.MayTry("one more", now));
  EXPECT_TRUE(limit.MayTry("one more", now + LoginLimit::kPeriod));
}

}  // namespace
}  // namespace homing::server
