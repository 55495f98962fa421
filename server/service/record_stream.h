// JourneyService.RecordJourney: recording that can be resumed.
#ifndef SERVER_SERVICE_RECORD_STREAM_H_
#define SERVER_SERVICE_RECORD_STREAM_H_

#include <cstdint>
#include <memory>
#include <string>

#include "homing/v1/journey_service.pb.h"
#include "server/rpc/bidi_stream.h"

namespace homing::server {

class RecordStream final : public BidiStream<v1::RecordJourneyRequest, v1::RecordJourneyResponse> {
 public:
  RecordStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : BidiStream(core, context, Rpc::kRecordJourney) {}

 protected:
  WorkerPool* OtherPoolOf(const v1::RecordJourneyRequest& request) override;
  absl::Status Handle(const v1::RecordJourneyRequest& request) override;
  // Ends the stream after the pending appends are committed.
  void EndInTurn(const absl::Status& status) override;
  void HandleDone() override {
    session_.reset();
    presence_.reset();
  }

 private:
  absl::Status Begin(const v1::RecordingConfig& config);
  absl::Status Record(const v1::Observation& observation);
  absl::Status CheckLimits();

  std::shared_ptr<RecordingSession> session_;
  std::string journey_;
  std::shared_ptr<FleetBoard::Presence> presence_;
  // Observations read, and handled.
  std::int64_t read_ = 0;
  std::int64_t handled_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_RECORD_STREAM_H_
