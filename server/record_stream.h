// JourneyService.RecordJourney. Source: own design (resumable recording).
#ifndef SERVER_RECORD_STREAM_H_
#define SERVER_RECORD_STREAM_H_

#include <memory>

#include "homing/v1/journey_service.pb.h"
#include "server/bidi_stream.h"

namespace homing::server {

class RecordStream final : public BidiStream<v1::RecordJourneyRequest, v1::RecordJourneyResponse> {
 public:
  explicit RecordStream(ServiceCore* core) : BidiStream(core) {}

 protected:
  absl::Status Handle(const v1::RecordJourneyRequest& request) override;
  void HandleDrain() override;
  void HandleDone() override { session_.reset(); }

 private:
  absl::Status Begin(const v1::RecordingConfig& config);
  absl::Status Record(const v1::Observation& observation);

  std::shared_ptr<RecordingSession> session_;
};

}  // namespace homing::server

#endif  // SERVER_RECORD_STREAM_H_
