// Server-sent events for one browser: the fleet, and the robots that its pages show.
#ifndef SERVER_HTTP_EVENT_FEED_H_
#define SERVER_HTTP_EVENT_FEED_H_

#include <grpcpp/client_context.h>

#include <chrono>
#include <deque>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "homing/base/mutex.h"
#include "server/http/api_gateway.h"

namespace homing::server {

// Thread-safe. Each source has a thread, which waits while the browser is slow; the server then
// skips states.
class EventFeed {
 public:
  // The gateway must outlive the feed.
  EventFeed(const ApiGateway& gateway, const ApiCaller& caller,
            const std::vector<std::string>& robots);
  // Ends the streams and waits for them.
  ~EventFeed();
  EventFeed(const EventFeed&) = delete;
  EventFeed& operator=(const EventFeed&) = delete;

  // The next event as text; empty: there was none within `most`. std::nullopt: the end.
  std::optional<std::string> Next(std::chrono::milliseconds most);
  void Stop();

 private:
  // Reads the stream of FleetService's `method` to its end.
  void Follow(const char* event, const char* method, const ApiCaller& caller,
              const google::protobuf::Message& request, google::protobuf::Message* response);
  bool Push(std::string text);

  const ApiGateway& gateway_;
  Mutex mutex_;
  ConditionVariable changed_;
  std::deque<std::string> events_ HOMING_GUARDED_BY(mutex_);
  std::list<grpc::ClientContext> contexts_ HOMING_GUARDED_BY(mutex_);
  bool stopped_ HOMING_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace homing::server

#endif  // SERVER_HTTP_EVENT_FEED_H_
