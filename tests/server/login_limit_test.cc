#include "server/http/login_limit.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "server/access/token_book.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

TEST(LoginLimitTest, AnAddressMayTryAgainAMinuteLater) {
  LoginLimit limit;
  const LoginLimit::Time now;
  for (int i = 0; i < LoginLimit::kMostFailures; ++i) {
    EXPECT_TRUE(limit.MayFail("1.2.3.4", now));
  }
  EXPECT_FALSE(limit.MayFail("1.2.3.4", now));
  EXPECT_TRUE(limit.MayFail("1.2.3.5", now));
  EXPECT_TRUE(limit.MayFail("1.2.3.4", now + LoginLimit::kPeriod));
  for (int i = 0; i < 20'000; ++i) limit.MayFail(std::to_string(i), now);
  EXPECT_FALSE(limit.MayFail("one more", now));
  EXPECT_TRUE(limit.MayFail("one more", now + LoginLimit::kPeriod));
}

class LoginTest : public ServerTest {
 protected:
  LoginTest() { options_.http = "127.0.0.1:0"; }
  httplib::Client Browser() { return httplib::Client("http://" + server_->metrics_address()); }
  void StartGuarded() {
    options_.tokens = folder_.File("tokens.toml");
    EXPECT_THAT(AddToken(options_.tokens, "robots/r", HashToken("secret-r")), IsOk());
    EXPECT_THAT(AddToken(options_.tokens, "operators/o", HashToken("secret-o")), IsOk());
    StartServer();
  }
};

TEST_F(LoginTest, OneTokenDoesNotTakeAllSessions) {
  StartGuarded();
  auto browser = Browser();
  std::string oldest, newest;
  for (int i = 0; i < 1100; ++i) {
    const auto login = browser.Post("/api/v1/login", R"({"token":"secret-r"})", "");
    ASSERT_EQ(login->status, 200) << i;
    newest = login->get_header_value("Set-Cookie");
    newest = newest.substr(0, newest.find(';'));
    if (oldest.empty()) oldest = newest;
  }
  EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"secret-o"})", "")->status, 200);
  EXPECT_EQ(browser.Get("/api/v1/session", {{"Cookie", oldest}})->status, 401);
  EXPECT_EQ(browser.Get("/api/v1/session", {{"Cookie", newest}})->status, 200);
}

TEST_F(LoginTest, OneTokenDoesNotTakeAllEventStreams) {
  StartGuarded();
  const auto cookie_of = [&](const char* token) {
    const std::string body = std::string(R"({"token":")") + token + "\"}";
    const std::string cookie =
        Browser().Post("/api/v1/login", body, "")->get_header_value("Set-Cookie");
    return cookie.substr(0, cookie.find(';'));
  };
  std::atomic<int> open = 0;
  std::atomic<bool> done = false;
  // Reads until `done`; gives the status.
  const auto watch = [&](const std::string& cookie) {
    int status = 0;
    Browser().Get(
        "/events", {{"Cookie", cookie}},
        [&](const httplib::Response& response) {
          status = response.status;
          open += status == 200 ? 1 : 0;
          return true;
        },
        [&](const char*, std::size_t) {
          while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(5));
          return false;
        });
    return status;
  };
  const std::string robot = cookie_of("secret-r");
  std::vector<std::future<int>> feeds;
  for (int i = 0; i < 16; ++i) feeds.push_back(std::async(std::launch::async, watch, robot));
  while (open < 16) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(Browser().Get("/events", {{"Cookie", robot}})->status, 503);
  feeds.push_back(std::async(std::launch::async, watch, cookie_of("secret-o")));
  while (open < 17 &&
         feeds.back().wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
  }
  done = true;
  for (auto& feed : feeds) EXPECT_EQ(feed.get(), 200);
}

TEST_F(LoginTest, GuessesOfAnAddressDoNotLockOutItsOthers) {
  StartGuarded();
  auto browser = Browser();
  for (int i = 0; i < LoginLimit::kMostFailures; ++i) {
    EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"guess"})", "")->status, 401);
  }
  EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"guess"})", "")->status, 429);
  EXPECT_EQ(browser.Post("/api/v1/login", R"({"token":"secret-r"})", "")->status, 200);
  EXPECT_EQ(browser.Post("/login?once=guess")->get_header_value("Location"), "/#/login?link=used");
  EXPECT_EQ(browser.Get("/healthz")->status, 200);
}

}  // namespace
}  // namespace homing::server
