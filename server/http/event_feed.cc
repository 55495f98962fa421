#include "server/http/event_feed.h"

#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/sync_stream.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/v1/fleet_service.pb.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxWaiting = 8;
// Time after which a browser reconnects, for example after a restart of the server, ms.
constexpr int kRetryMs = 500;

}  // namespace

EventFeed::EventFeed(const ApiGateway& gateway, const ApiCaller& caller,
                     const std::vector<std::string>& robots)
    : gateway_(gateway) {
  events_.push_back(absl::StrCat("retry: ", kRetryMs, "\n\n"));
  threads_.emplace_back([this, caller] {
    v1::WatchFleetResponse response;
    Follow("fleet", "/homing.v1.FleetService/WatchFleet", caller, v1::WatchFleetRequest(),
           &response);
  });
  for (const std::string& robot : robots) {
    threads_.emplace_back([this, caller, robot] {
      v1::WatchRobotRequest request;
      request.set_name(robot);
      v1::WatchRobotResponse response;
      Follow("robot", "/homing.v1.FleetService/WatchRobot", caller, request, &response);
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

void EventFeed::Follow(const char* event, const char* method, const ApiCaller& caller,
                       const google::protobuf::Message& request,
                       google::protobuf::Message* response) {
  grpc::ClientContext* context = nullptr;
  {
    const MutexLock lock(mutex_);
    if (stopped_) return;
    context = &contexts_.emplace_back();
  }
  caller.AddTo(context);
  const grpc::internal::RpcMethod call(method, grpc::internal::RpcMethod::SERVER_STREAMING);
  const std::unique_ptr<grpc::ClientReader<grpc::ByteBuffer>> reader(
      grpc::internal::ClientReaderFactory<grpc::ByteBuffer>::Create(gateway_.channel().get(), call,
                                                                    context, request));
  grpc::ByteBuffer bytes;
  while (reader->Read(&bytes)) {
    const std::string json = gateway_.ToSharedJson(bytes, response);
    if (!Push(absl::StrCat("event: ", event, "\ndata: ", json, "\n\n"))) context->TryCancel();
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
