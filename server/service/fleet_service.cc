#include "server/service/fleet_service.h"

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/base/resource_name.h"
#include "server/rpc/page.h"
#include "server/rpc/watch_stream.h"

namespace homing::server {
namespace {

constexpr int kRecordsAtOnce = 1000;

class FleetStream final : public WatchStream<v1::WatchFleetRequest, v1::WatchFleetResponse> {
 public:
  FleetStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : WatchStream(core, context, Rpc::kWatchFleet) {}

 private:
  std::string ResourceOf(const v1::WatchFleetRequest& /*request*/) override { return ""; }
  absl::Status Prepare(ServiceCore* core, const std::string& /*robot*/) override {
    return CountStoredJourneys(core);
  }

  bool Next(ServiceCore* core, const IncomingCall& call,
            v1::WatchFleetResponse* response) override {
    const bool first = since_ < 0;
    std::vector<v1::Robot> changed;
    since_ = core->fleet.ChangesSince(since_, &changed);
    for (v1::Robot& robot : changed) {
      if (call.SeesRobot(robot.name())) *response->add_robots() = std::move(robot);
    }
    return first || response->robots_size() > 0;
  }

  std::int64_t since_ = -1;
};

class RobotStream final : public WatchStream<v1::WatchRobotRequest, v1::WatchRobotResponse> {
 public:
  RobotStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : WatchStream(core, context, Rpc::kWatchRobot) {}

 private:
  std::string ResourceOf(const v1::WatchRobotRequest& request) override { return request.name(); }
  absl::Status Prepare(ServiceCore* /*core*/, const std::string& robot) override {
    robot_ = robot;
    return ParseRobotName(robot_, "name", false).status();
  }

  bool Next(ServiceCore* core, const IncomingCall& /*call*/,
            v1::WatchRobotResponse* response) override {
    FleetBoard::Update update = core->fleet.Newest(robot_);
    if (update.number <= sent_) return false;
    sent_ = update.number;
    *response = std::move(update.response);
    return true;
  }

  std::string robot_;
  // -1: the first message is sent even without a change.
  std::int64_t sent_ = -1;
};

}  // namespace

FleetServiceHandler::FleetServiceHandler(ServiceCore* core) : ApiService(core) {
  AddUnary(Rpc::kListRobots, &FleetServiceHandler::ListRobots);
  AddStream<FleetStream, v1::WatchFleetResponse>(Rpc::kWatchFleet);
  AddStream<RobotStream, v1::WatchRobotResponse>(Rpc::kWatchRobot);
}

absl::Status CountStoredJourneys(ServiceCore* core) {
  const TimePoint asked = std::chrono::steady_clock::now();
  const MutexLock lock(core->count_mutex);
  // Of many callers at the same time one counts for all.
  if (core->counted > asked) return absl::OkStatus();
  const TimePoint begin = std::chrono::steady_clock::now();
  std::map<std::string, FleetBoard::Stored> stored;
  std::string after;
  for (bool more = true; more;) {
    HOMING_ASSIGN_OR_RETURN(const std::vector<storage::JourneyRecord> records,
                            core->catalog.List(kWildcard, after, kRecordsAtOnce));
    for (const storage::JourneyRecord& record : records) {
      FleetBoard::Stored& robot = stored[record.name.substr(0, record.name.find("/journeys/"))];
      ++robot.journeys;
      robot.newest_ns = std::max(robot.newest_ns, record.create_time_ns);
      after = record.name;
    }
    more = records.size() == kRecordsAtOnce;
  }
  core->fleet.SetStored(stored);
  core->counted = begin;
  return absl::OkStatus();
}

void FleetServiceHandler::ListRobots(const UnaryCall::Ptr& call,
                                     const v1::ListRobotsRequest* request,
                                     v1::ListRobotsResponse* response) {
  ServeUnary(
      call, "",
      [core = core(), request, response](const JourneyFilter& /*all*/,
                                         const IncomingCall& incoming) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const int size, DecodePageSize(request->page_size()));
        HOMING_ASSIGN_OR_RETURN(std::string after,
                                DecodePageToken("robots", request->page_token()));
        HOMING_RETURN_IF_ERROR(CountStoredJourneys(core));
        for (bool more = true; more;) {
          const std::vector<v1::Robot> robots = core->fleet.List(after, kRecordsAtOnce);
          more = robots.size() == kRecordsAtOnce;
          for (const v1::Robot& robot : robots) {
            if (!incoming.SeesRobot(robot.name())) continue;
            if (response->robots_size() == size) {
              response->set_next_page_token(
                  EncodePageToken("robots", response->robots(size - 1).name()));
              return absl::OkStatus();
            }
            *response->add_robots() = robot;
          }
          if (more) after = robots.back().name();
        }
        return absl::OkStatus();
      },
      &core()->store_reads);
}

}  // namespace homing::server
