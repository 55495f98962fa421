// The HTTP side over a real socket: logins, roles, and the checks of where a request comes from.
#include <httplib.h>

#include <algorithm>
#include <future>
#include <nlohmann/json.hpp>
#include <vector>

#include "homing/v1/fleet_service.pb.h"
#include "server/access/certificate_folder.h"
#include "server/access/token_book.h"
#include "server/http/api_gateway.h"
#include "server/http/request_guard.h"
#include "tests/server/server_fixture.h"
#include "tests/support/journey_file.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class HttpTest : public ServerTest {
 protected:
  HttpTest() { options_.http = "127.0.0.1:0"; }
  httplib::Client Browser() {
    httplib::Client browser("http://" + server_->metrics_address());
    // A large answer takes a busy machine long under a sanitizer.
    browser.set_read_timeout(60);
    return browser;
  }
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

// As JSON, each browser would need several times as much.
TEST_F(HttpTest, AVeryLargeAnswerIsRefused) {
  StartServer();
  ASSERT_THAT(Import("robots/r/journeys/large", test::JourneyFile(100'000, 2), 1 << 20),
              IsGrpcOk());
  const httplib::Headers headers = {{"X-CSRF-Token", Session({})["csrf"].get<std::string>()}};
  const auto answer = Browser().Post(
      "/api/v1/JourneyService/ListLandmarks", headers,
      R"({"parent":"robots/r/journeys/large","includeFingerprints":true})", "application/json");
  EXPECT_EQ(answer->status, 429);
  EXPECT_THAT(answer->body, HasSubstr("pageSize"));
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
  const auto first = browser.Post(path);
  EXPECT_EQ(first->status, 303);
  EXPECT_EQ(Session({{"Cookie", CookieIn(first)}})["role"], "operator");
  EXPECT_FALSE(browser.Post(path)->has_header("Set-Cookie"));
}

TEST_F(HttpTest, WhatLooksAtALinkDoesNotUseIt) {
  StartGuarded();
  const std::string link = server_->console_link(true);
  auto browser = Browser();
  const std::string path = link.substr(link.find("/login"));
  for (const auto& answer : {browser.Head(path), browser.Get(path), browser.Options(path)}) {
    EXPECT_FALSE(answer->has_header("Set-Cookie"));
  }
  EXPECT_THAT(browser.Get(path)->body, HasSubstr("method=\"post\""));
  EXPECT_EQ(browser.Get(path)->get_header_value("Referrer-Policy"), "same-origin");
  const httplib::Headers other_site = {{"Origin", "http://evil.example"}};
  EXPECT_EQ(browser.Post(path, other_site, "", "application/x-www-form-urlencoded")->status, 403);
  const httplib::Headers same_site = {{"Origin", "http://" + server_->metrics_address()}};
  EXPECT_TRUE(browser.Post(path, same_site, "", "application/x-www-form-urlencoded")
                  ->has_header("Set-Cookie"));
}

TEST_F(HttpTest, OfBrowsersThatFollowALinkAtTheSameTimeOneGetsTheSession) {
  StartGuarded();
  const std::string link = server_->console_link(true);
  const std::string path = link.substr(link.find("/login"));
  std::vector<std::future<bool>> browsers;
  for (int i = 0; i < 8; ++i) {
    browsers.push_back(std::async(std::launch::async,
                                  [&] { return Browser().Post(path)->has_header("Set-Cookie"); }));
  }
  EXPECT_EQ(std::count_if(browsers.begin(), browsers.end(), [](auto& got) { return got.get(); }),
            1);
}

TEST_F(HttpTest, AProxyNamesTheUserOnlyIfItsHeaderIsSetUp) {
  StartGuarded();
  EXPECT_EQ(Browser().Get("/api/v1/session", {{"X-Forwarded-User", "anna"}})->status, 401);
  options_.http_user_header = "X-Forwarded-User";
  StartServer();
  EXPECT_EQ(Session({{"X-Forwarded-User", "anna"}})["identity"], "operators/anna");
  EXPECT_EQ(Browser().Get("/api/v1/session", {{"X-Forwarded-User", "an/na"}})->status, 400);
}

TEST_F(HttpTest, WithACertificateItSpeaksTlsAlone) {
  CertificateOrder order;
  order.folder = folder_.File("pki");
  ASSERT_THAT(MakeCertificates(order), IsOk());
  options_.tls_cert = folder_.File("pki/server.pem");
  options_.tls_key = folder_.File("pki/server.key");
  StartGuarded();
  EXPECT_THAT(server_->console_link(false), ::testing::StartsWith("https://127.0.0.1:"));
  const auto port = std::stoi(server_->metrics_address().substr(10));
  httplib::SSLClient browser("127.0.0.1", port);
  browser.set_ca_cert_path(folder_.File("pki/ca.pem").c_str());
  browser.enable_server_certificate_verification(true);
  const auto health = browser.Get("/healthz");
  ASSERT_TRUE(health) << httplib::to_string(health.error());
  EXPECT_EQ(health->body, "ok\n");
  const auto login = browser.Post("/api/v1/login", R"({"token":"secret-o"})", "application/json");
  EXPECT_THAT(login->get_header_value("Set-Cookie"), HasSubstr("; Secure"));
  const httplib::Headers cookie = {{"Cookie", CookieIn(login)}};
  const auto session = nlohmann::json::parse(browser.Get("/api/v1/session", cookie)->body);
  httplib::Headers headers = cookie;
  headers.emplace("X-CSRF-Token", session["csrf"].get<std::string>());
  // Its own call of gRPC speaks TLS too.
  EXPECT_EQ(browser.Post("/api/v1/FleetService/ListRobots", headers, "{}", "")->status, 200);
  EXPECT_FALSE(Browser().Get("/healthz")) << "plain text";
  httplib::SSLClient stranger("127.0.0.1", port);
  stranger.enable_server_certificate_verification(true);
  EXPECT_FALSE(stranger.Get("/healthz")) << "an authority that it does not trust";
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
}

// Kept texts are those of a type: the bytes of one robot are also those of a fleet of one.
TEST(ApiGatewayTest, AKeptTextIsThatOfItsMessage) {
  const ApiGateway gateway(nullptr);
  v1::WatchFleetResponse fleet;
  v1::WatchRobotResponse robot;
  const auto text_of = [&](const std::string& name, google::protobuf::Message* message) {
    robot.mutable_robot()->set_name(name);
    const std::string serialized = robot.SerializeAsString();
    const grpc::Slice slice(serialized.data(), serialized.size());
    return gateway.ToSharedJson(grpc::ByteBuffer(&slice, 1), message);
  };
  for (int times = 0; times < 2; ++times) {
    EXPECT_EQ(text_of("robots/a", &fleet), R"({"robots":[{"name":"robots/a"}]})");
    EXPECT_EQ(text_of("robots/a", &robot), R"({"robot":{"name":"robots/a"}})");
    EXPECT_EQ(text_of("robots/b", &fleet), R"({"robots":[{"name":"robots/b"}]})");
    EXPECT_EQ(text_of("robots/b", &robot), R"({"robot":{"name":"robots/b"}})");
  }
}

}  // namespace
}  // namespace homing::server
