#include "server/http/event_feed.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/v1/fleet_service.grpc.pb.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxWaiting = 8;
// Time after which a browser reconnects, for example after a restart of the server, ms.
constexpr int kRetryMs = 500;

}  // namespace

EventFeed::EventFeed(const ApiGateway& gateway, const ApiCaller& caller,
                     const std::vector<std::string>& robots)
    : channel_(gateway.channel()) {
  events_.push_back(absl::StrCat("retry: ", kRetryMs, "\n\n"));
  threads_.emplace_back([this, caller] {
    Follow<v1::WatchFleetResponse>(
        "fleet", caller, [](auto* stub, auto* context) { return stub->WatchFleet(context, {}); });
  });
  for (const std::string& robot : robots) {
    threads_.emplace_back([this, caller, robot] {
      Follow<v1::WatchRobotResponse>("robot", caller, [&](auto* stub, auto* context) {
        v1::WatchRobotRequest request;
        request.set_name(robot);
        return stub->WatchRobot(context, request);
      });
    });
  }
}

EventFeed::~EventFeed() {
  Stop();
  for (std::thread& thread : threads_) thread.join();
}

void EventFeed::Stop() {
  const MutexLock lock(mutex_);
  stopped_ = true;
  for (grpc::ClientContext& context : contexts_) context.TryCancel();
  changed_.NotifyAll();
}

template <typename Response, typename Start>
void EventFeed::Follow(const char* event, const ApiCaller& caller, Start start) {
  grpc::ClientContext* context = nullptr;
  {
    const MutexLock lock(mutex_);
    if (stopped_) return;
    context = &contexts_.emplace_back();
  }
  caller.AddTo(context);
  const auto stub = v1::FleetService::NewStub(channel_);
  const auto reader = start(stub.get(), context);
  Response response;
  while (reader->Read(&response)) {
    if (!Push(absl::StrCat("event: ", event, "\ndata: ", ToJson(response), "\n\n"))) {
      context->TryCancel();
    }
  }
  Push(absl::StrCat("event: end\ndata: ", ToAnswer(reader->Finish()).json, "\n\n"));
  Stop();
}

bool EventFeed::Push(std::string text) {
  const MutexLock lock(mutex_);
  while (!stopped_ && events_.size() >= kMaxWaiting) changed_.Wait(mutex_);
  if (stopped_) return false;
  events_.push_back(std::move(text));
  changed_.NotifyAll();
  return true;
}

std::optional<std::string> EventFeed::Next(std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  const MutexLock lock(mutex_);
  while (events_.empty() && !stopped_ && changed_.WaitUntil(mutex_, end)) {
  }
  if (!events_.empty()) {
    std::string text = std::move(events_.front());
    events_.pop_front();
    changed_.NotifyAll();
    return text;
  }
  return stopped_ ? std::nullopt : std::optional<std::string>("");
}

}  // namespace homing::server
