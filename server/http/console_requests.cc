// What each request of ConsoleServer does.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/trace_parent.h"
#include "server/http/console_assets.h"
#include "server/http/console_state.h"
#include "server/http/request_guard.h"

namespace homing::server {
namespace {

using httplib::Request;
using httplib::Response;

constexpr std::size_t kMaxFeeds = 32;
// Most feeds of one token: its holder cannot take those of the others.
constexpr std::ptrdiff_t kMaxFeedsOfToken = 16;
constexpr std::size_t kMaxRobots = 8;
constexpr std::chrono::seconds kAlive{5};
constexpr char kCookie[] = "homing_session";
constexpr char kJsonType[] = "application/json; charset=utf-8";
// Forbids scripts, styles and connections of other sites, and a frame around the console.
constexpr char kContentPolicy[] =
    "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src 'self'; "
    "connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'";
// Its form is sent to the address of the page, with the link's secret.
constexpr char kLinkPage[] =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
    "content=\"width=device-width\"><title>Homing</title><link rel=\"icon\" href=\"/icon.svg\">"
    "<link rel=\"stylesheet\" href=\"/app.css\"><main class=\"login\"><h1>Homing</h1>"
    "<form class=\"card\" method=\"post\">"
    "<button class=\"primary\" autofocus>Log in</button></form></main></html>\n";

void SetSafeHeaders(const Request& request, Response* response) {
  response->set_header("Content-Security-Policy", kContentPolicy);
  response->set_header("X-Content-Type-Options", "nosniff");
  response->set_header("X-Frame-Options", "DENY");
  // With "no-referrer" a browser sends the form of the page without its origin.
  response->set_header("Referrer-Policy", request.path == "/login" ? "same-origin" : "no-referrer");
  response->set_header("Cross-Origin-Opener-Policy", "same-origin");
  response->set_header("Cross-Origin-Resource-Policy", "same-origin");
}

std::string TraceOf(const Request& request) {
  std::string trace = request.get_header_value("traceparent");
  return ParseTraceParent(trace) ? trace : "";
}

}  // namespace

void Send(Response* response, std::string body, const char* type) {
  const auto kept = std::make_shared<const std::string>(std::move(body));
  if (kept->empty()) return;
  response->set_content_provider(
      kept->size(), type, [kept](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(kept->data() + offset, length);
      });
}

void Send(Response* response, const ApiAnswer& answer) {
  response->status = answer.status;
  response->set_header("Cache-Control", "no-store");
  Send(response, answer.json, kJsonType);
}

// /metrics and /healthz are exempt: scrapers and probes have no login, and no browser that could be
// misled.
bool ConsoleServer::State::Refuse(const Request& request, Response* response) const {
  if (request.path == "/metrics" || request.path == "/healthz") return false;
  SetSafeHeaders(request, response);
  const std::string host = request.get_header_value("Host");
  absl::Status status;
  if (!IsKnownHost(host, options.hosts)) {
    status = absl::PermissionDeniedError(
        "this server does not know that name; use its address, or name it with --http-host");
  } else if (!IsSameOrigin(request.get_header_value("Origin"), host) ||
             request.get_header_value("Sec-Fetch-Site") == "cross-site") {
    const bool page =
        request.method == "GET" && request.get_header_value("Sec-Fetch-Mode") == "navigate";
    if (page) return false;
    status = absl::PermissionDeniedError("the request comes from another site");
  }
  if (status.ok()) return false;
  Send(response, ToAnswer(status));
  return true;
}

absl::StatusOr<Login> ConsoleServer::State::LoginOf(const Request& request) {
  if (context.access->is_open()) return sessions.OfAnybody();
  if (!options.user_header.empty() && request.has_header(options.user_header)) {
    const std::string user = request.get_header_value(options.user_header);
    return sessions.OfUser(absl::StrCat("operators/", user));
  }
  const auto login = sessions.Find(CookieOf(request.get_header_value("Cookie"), kCookie));
  if (!login) return absl::UnauthenticatedError("log in first");
  return *login;
}

std::string ConsoleServer::State::CookieHeader(const Request& request, const std::string& cookie,
                                               int seconds) const {
  const bool tls =
      !options.tls_cert.empty() || request.get_header_value("X-Forwarded-Proto") == "https";
  return absl::StrCat(kCookie, "=", cookie,
                      "; Path=/; HttpOnly; SameSite=Strict; Max-Age=", seconds,
                      tls ? "; Secure" : "");
}

absl::StatusOr<std::string> ConsoleServer::State::Try(
    const Request& request, const std::string& what,
    const std::function<absl::StatusOr<std::string>()>& open) {
  const auto now = std::chrono::steady_clock::now();
  const std::string& from = request.remote_addr;
  auto cookie = open();
  if (!cookie.ok() && !logins.MayFail(from, now)) {
    return absl::ResourceExhaustedError("too many logins from your address failed; wait a minute");
  }
  spdlog::info("audit: {} from {}: {}", what, from, cookie.ok() ? "ok" : "refused");
  return cookie;
}

void ConsoleServer::State::LogIn(const Request& request, Response* response) {
  const auto body = nlohmann::json::parse(request.body, nullptr, false);
  const bool good = body.is_object() && body.contains("token") && body["token"].is_string();
  const auto cookie = Try(request, "login", [&] {
    return sessions.Open(good ? body["token"].get<std::string>() : "");
  });
  if (!cookie.ok()) {
    Send(response, ToAnswer(cookie.status()));
    return;
  }
  const int life = static_cast<int>(std::chrono::seconds(SessionBook::kLife).count());
  response->set_header("Set-Cookie", CookieHeader(request, *cookie, life));
  Send(response, {200, "{}"});
}

// Programs that look at links (mail scanners, previews in chats) send GET or HEAD: these must not
// use the link up.
void ConsoleServer::State::ShowLink(const Request& /*request*/, Response* response) {
  response->set_header("Cache-Control", "no-store");
  Send(response, kLinkPage, "text/html; charset=utf-8");
}

void ConsoleServer::State::FollowLink(const Request& request, Response* response) {
  const auto cookie = Try(request, "login by link",
                          [&] { return sessions.TakeLink(request.get_param_value("once")); });
  if (cookie.ok()) {
    const int life = static_cast<int>(std::chrono::seconds(SessionBook::kLife).count());
    response->set_header("Set-Cookie", CookieHeader(request, *cookie, life));
  }
  response->status = 303;
  response->set_header("Cache-Control", "no-store");
  response->set_header("Location", cookie.ok() ? "/" : "/#/login?link=used");
}

void ConsoleServer::State::LogOut(const Request& request, Response* response) {
  sessions.Close(CookieOf(request.get_header_value("Cookie"), kCookie));
  response->set_header("Set-Cookie", CookieHeader(request, "", 0));
  Send(response, {200, "{}"});
}

void ConsoleServer::State::ShowSession(const Request& request, Response* response) {
  const auto login = LoginOf(request);
  if (!login.ok()) {
    Send(response, ToAnswer(login.status()));
    return;
  }
  Credentials credentials;
  credentials.authorizations = {"Bearer " + login->token};
  const auto caller = context.access->Identify(credentials);
  if (!caller.ok()) {
    Send(response, ToAnswer(caller.status()));
    return;
  }
  const nlohmann::json shown = {{"identity", caller->identity},
                                {"role", NameOf(caller->role)},
                                {"csrf", login->csrf},
                                {"open", context.access->is_open()},
                                {"version", HOMING_VERSION}};
  Send(response, {200, shown.dump()});
}

void ConsoleServer::State::CallApi(const Request& request, Response* response) {
  const auto login = LoginOf(request);
  if (!login.ok()) {
    Send(response, ToAnswer(login.status()));
    return;
  }
  if (request.get_header_value("X-CSRF-Token") != login->csrf) {
    Send(response, ToAnswer(absl::PermissionDeniedError("X-CSRF-Token must be that of the login")));
    return;
  }
  Send(response, gateway.Call(request.matches[1], request.body, {login->token, TraceOf(request)}));
}

std::shared_ptr<EventFeed> ConsoleServer::State::AddFeed(const Login& login,
                                                         const Request& request) {
  std::vector<std::string> robots;
  const auto [begin, end] = request.params.equal_range("robot");
  for (auto i = begin; i != end && robots.size() < kMaxRobots; ++i) robots.push_back(i->second);
  const MutexLock lock(mutex);
  const auto of_token = std::count_if(feeds.begin(), feeds.end(), [&](const auto& open) {
    return !login.token.empty() && open.second == login.token;
  });
  if (stopping || feeds.size() >= kMaxFeeds || of_token >= kMaxFeedsOfToken) return nullptr;
  auto feed =
      std::make_shared<EventFeed>(gateway, ApiCaller{login.token, TraceOf(request)}, robots);
  feeds[feed] = login.token;
  return feed;
}

void ConsoleServer::State::SendEvents(const Request& request, Response* response) {
  const auto login = LoginOf(request);
  if (!login.ok()) {
    Send(response, ToAnswer(login.status()));
    return;
  }
  const std::shared_ptr<EventFeed> feed = AddFeed(*login, request);
  if (!feed) {
    Send(response, ToAnswer(absl::UnavailableError("too many consoles are open")));
    return;
  }
  response->set_header("Cache-Control", "no-store");
  response->set_header("X-Accel-Buffering", "no");
  response->set_chunked_content_provider(
      "text/event-stream",
      [feed](std::size_t /*offset*/, httplib::DataSink& sink) {
        const auto text = feed->Next(kAlive);
        if (!text) {
          sink.done();
          return true;
        }
        const std::string sent = text->empty() ? ":\n\n" : *text;
        return sink.write(sent.data(), sent.size());
      },
      [this, feed](bool /*success*/) {
        feed->Stop();
        const MutexLock lock(mutex);
        feeds.erase(feed);
      });
}

void ConsoleServer::State::SendAsset(const Request& request, Response* response) const {
  const ConsoleAsset* asset = FindConsoleAsset(request.path);
  if (asset == nullptr) {
    Send(response, ToAnswer(absl::NotFoundError("no such page")));
    return;
  }
  response->set_header("Cache-Control", "no-cache");
  response->set_header("ETag", asset->tag);
  if (request.get_header_value("If-None-Match") == asset->tag) {
    response->status = 304;
    return;
  }
  const bool packed = request.get_header_value("Accept-Encoding").find("gzip") != std::string::npos;
  if (packed) response->set_header("Content-Encoding", "gzip");
  response->set_header("Vary", "Accept-Encoding");
  Send(response, packed ? asset->gzip : asset->text, asset->type);
}

}  // namespace homing::server
