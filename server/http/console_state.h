// The state of ConsoleServer, which its sources share.
#ifndef SERVER_HTTP_CONSOLE_STATE_H_
#define SERVER_HTTP_CONSOLE_STATE_H_

#include <httplib.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "homing/base/mutex.h"
#include "server/http/api_gateway.h"
#include "server/http/bounded_server.h"
#include "server/http/console_server.h"
#include "server/http/event_feed.h"
#include "server/http/login_limit.h"
#include "server/http/session_book.h"

namespace homing::server {

// Sends the body through a content provider: the library would compress any other body, slowly, at
// each request.
void Send(httplib::Response* response, std::string body, const char* type);
void Send(httplib::Response* response, const ApiAnswer& answer);

struct ConsoleServer::State {
  State(const ConsoleOptions& wanted, const ConsoleContext& shown)
      : options(wanted),
        context(shown),
        sessions(shown.access, [] { return std::chrono::steady_clock::now(); }),
        gateway(shown.channel) {}

  absl::Status Listen();
  void Route();
  bool Refuse(const httplib::Request& request, httplib::Response* response) const;
  // A new session; the failures of each address are limited. UNAUTHENTICATED, RESOURCE_EXHAUSTED.
  absl::StatusOr<std::string> Try(const httplib::Request& request, const std::string& what,
                                  const std::function<absl::StatusOr<std::string>()>& open);
  absl::StatusOr<Login> LoginOf(const httplib::Request& request);
  void LogIn(const httplib::Request& request, httplib::Response* response);
  void ShowLink(const httplib::Request& request, httplib::Response* response);
  void FollowLink(const httplib::Request& request, httplib::Response* response);
  void LogOut(const httplib::Request& request, httplib::Response* response);
  void ShowSession(const httplib::Request& request, httplib::Response* response);
  void CallApi(const httplib::Request& request, httplib::Response* response);
  void SendEvents(const httplib::Request& request, httplib::Response* response);
  // A feed for this login; null: the server stops, or too many are open.
  std::shared_ptr<EventFeed> AddFeed(const Login& login, const httplib::Request& request);
  void SendAsset(const httplib::Request& request, httplib::Response* response) const;
  std::string CookieHeader(const httplib::Request& request, const std::string& cookie,
                           int seconds) const;

  const ConsoleOptions options;
  const ConsoleContext context;
  SessionBook sessions;
  LoginLimit logins;
  const ApiGateway gateway;
  BoundedServer server;
  std::string address;
  Mutex mutex;
  // Each with the token of its login.
  std::map<std::shared_ptr<EventFeed>, std::string> feeds HOMING_GUARDED_BY(mutex);
  bool stopping HOMING_GUARDED_BY(mutex) = false;
  // The server no longer listens: Stop was called, or the system reported an error.
  std::atomic<bool> ended = false;
  std::thread thread;
};

}  // namespace homing::server

#endif  // SERVER_HTTP_CONSOLE_STATE_H_
