#include "server/http/console_server.h"

#include <spdlog/spdlog.h>

#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"
#include "server/http/console_state.h"

namespace homing::server {

using httplib::Request;
using httplib::Response;

void ConsoleServer::State::Route() {
  using Handled = httplib::Server::HandlerResponse;
  const auto to = [this](void (State::*handle)(const Request&, Response*)) {
    return [this, handle](const Request& request, Response& response) {
      (this->*handle)(request, &response);
    };
  };
  server.set_pre_routing_handler([this](const Request& request, Response& response) {
    return Refuse(request, &response) ? Handled::Handled : Handled::Unhandled;
  });
  server.set_exception_handler([](const Request&, Response& response, const std::exception_ptr&) {
    Send(&response, ToAnswer(absl::InternalError("the request failed")));
  });
  server.Get("/metrics", [this](const Request&, Response& response) {
    Send(&response, context.metrics(), "text/plain; version=0.0.4; charset=utf-8");
  });
  server.Get("/healthz", [this](const Request&, Response& response) {
    const bool well = context.healthy();
    response.status = well ? 200 : 503;
    Send(&response, well ? "ok\n" : "not serving\n", "text/plain; charset=utf-8");
  });
  server.Get("/login", to(&State::ShowLink));
  server.Post("/login", to(&State::FollowLink));
  server.Post("/api/v1/login", to(&State::LogIn));
  server.Post("/api/v1/logout", to(&State::LogOut));
  server.Get("/api/v1/session", to(&State::ShowSession));
  server.Post("/api/v1/([A-Za-z]+/[A-Za-z]+)", to(&State::CallApi));
  server.Get("/events", to(&State::SendEvents));
  server.Get("/.*",
             [this](const Request& request, Response& response) { SendAsset(request, &response); });
}

absl::Status ConsoleServer::State::Listen() {
  if (!options.tls_cert.empty()) {
    HOMING_RETURN_IF_ERROR(server.UseCertificate(options.tls_cert, options.tls_key));
  }
  Route();
  HOMING_ASSIGN_OR_RETURN(const HostPort parsed, ParseHostPort("http", options.address, 0));
  const bool any = parsed.port == 0;
  const int port = any ? server.bind_to_any_port(parsed.host)
                       : (server.bind_to_port(parsed.host, parsed.port) ? parsed.port : -1);
  if (port <= 0) {
    return absl::UnavailableError(absl::StrCat("http: \"", options.address,
                                               "\" is in use or is not an address of this "
                                               "machine"));
  }
  address = absl::StrCat(options.address.substr(0, options.address.rfind(':')), ":", port);
  thread = std::thread([this] {
    if (!server.listen_after_bind()) spdlog::error("http: no more connections are accepted");
    ended = true;
  });
  return absl::OkStatus();
}

ConsoleServer::ConsoleServer(std::unique_ptr<State> state) : state_(std::move(state)) {}

ConsoleServer::~ConsoleServer() {
  if (!state_->thread.joinable()) return;
  Stop();
  state_->thread.join();
}

void ConsoleServer::Stop() {
  std::map<std::shared_ptr<EventFeed>, std::string> feeds;
  {
    const MutexLock lock(state_->mutex);
    if (std::exchange(state_->stopping, true)) return;
    feeds = state_->feeds;
  }
  for (const auto& [feed, token] : feeds) feed->Stop();
  // stop() has no effect before the server listens.
  while (!state_->server.is_running() && !state_->ended) std::this_thread::yield();
  state_->server.StopServing();
}

const std::string& ConsoleServer::address() const { return state_->address; }

std::string ConsoleServer::url() const {
  return absl::StrCat(state_->options.tls_cert.empty() ? "http://" : "https://", state_->address);
}

absl::StatusOr<std::string> ConsoleServer::MakeLoginLink(const std::string& identity) {
  HOMING_ASSIGN_OR_RETURN(const std::string secret, state_->sessions.MakeLink(identity));
  return absl::StrCat(url(), "/login?once=", secret);
}

absl::Status ConsoleServer::ReloadCertificate() {
  const ConsoleOptions& options = state_->options;
  if (options.tls_cert.empty()) return absl::OkStatus();
  return state_->server.UseCertificate(options.tls_cert, options.tls_key);
}

absl::StatusOr<std::unique_ptr<ConsoleServer>> ConsoleServer::Start(const ConsoleOptions& options,
                                                                    const ConsoleContext& context) {
  auto state = std::make_unique<State>(options, context);
  HOMING_RETURN_IF_ERROR(state->Listen());
  return std::unique_ptr<ConsoleServer>(new ConsoleServer(std::move(state)));
}

}  // namespace homing::server
