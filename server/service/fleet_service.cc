#include "server/service/fleet_service.h"

#include <map>
#include <string>
#include <vector>

#include "homing/base/status_macros.h"
#include "server/base/resource_name.h"
#include "server/rpc/page.h"
#include "server/rpc/unary_call.h"
#include "server/rpc/watch_stream.h"

namespace homing::server {
namespace {

constexpr int kRecordsAtOnce = 1000;

class FleetStream final : public WatchStream<v1::WatchFleetResponse> {
 public:
  FleetStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : WatchStream(core, context, Rpc::kWatchFleet, "") {}

 private:
  absl::Status Prepare(ServiceCore* core) override { return CountStoredJourneys(core); }

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

class RobotStream final : public WatchStream<v1::WatchRobotResponse> {
 public:
  RobotStream(ServiceCore* core, grpc::CallbackServerContext* context, const std::string& robot)
      : WatchStream(core, context, Rpc::kWatchRobot, robot), robot_(robot) {}

 private:
  absl::Status Prepare(ServiceCore* /*core*/) override {
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

  const std::string robot_;
  // -1: the first message is sent even without a change.
  std::int64_t sent_ = -1;
};

}  // namespace

absl::Status CountStoredJourneys(ServiceCore* core) {
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
  return absl::OkStatus();
}

grpc::ServerUnaryReactor* FleetServiceHandler::ListRobots(grpc::CallbackServerContext* context,
                                                          const v1::ListRobotsRequest* request,
                                                          v1::ListRobotsResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kListRobots, "", response,
      [core = core_, request, response](const JourneyFilter& /*all*/,
                                        const IncomingCall& call) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const int size, DecodePageSize(request->page_size()));
        HOMING_ASSIGN_OR_RETURN(std::string after,
                                DecodePageToken("robots", request->page_token()));
        HOMING_RETURN_IF_ERROR(CountStoredJourneys(core));
        for (bool more = true; more;) {
          const std::vector<v1::Robot> robots = core->fleet.List(after, kRecordsAtOnce);
          more = robots.size() == kRecordsAtOnce;
          for (const v1::Robot& robot : robots) {
            if (!call.SeesRobot(robot.name())) continue;
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
      &core_->store_reads);
}

grpc::ServerWriteReactor<v1::WatchFleetResponse>* FleetServiceHandler::WatchFleet(
    grpc::CallbackServerContext* context, const v1::WatchFleetRequest* /*request*/) {
  const auto stream = std::make_shared<FleetStream>(core_, context);
  stream->Open();
  return stream.get();
}

grpc::ServerWriteReactor<v1::WatchRobotResponse>* FleetServiceHandler::WatchRobot(
    grpc::CallbackServerContext* context, const v1::WatchRobotRequest* request) {
  const auto stream = std::make_shared<RobotStream>(core_, context, request->name());
  stream->Open();
  return stream.get();
}

}  // namespace homing::server
