// HomingService.Localize.
#ifndef SERVER_SERVICE_LOCALIZE_STREAM_H_
#define SERVER_SERVICE_LOCALIZE_STREAM_H_

#include <memory>

#include "homing/v1/homing_service.pb.h"
#include "server/rpc/bidi_stream.h"
#include "server/session/localization_session.h"

namespace homing::server {

class LocalizeStream final : public BidiStream<v1::LocalizeRequest, v1::LocalizeResponse> {
 public:
  LocalizeStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : BidiStream(core, context, Rpc::kLocalize) {}

 protected:
  WorkerPool* OtherPoolOf(const v1::LocalizeRequest& request) override;
  absl::Status Handle(const v1::LocalizeRequest& request) override;
  void HandleDone() override {
    session_.reset();
    presence_.reset();
  }

 private:
  absl::Status Begin(const v1::LocalizeConfig& config);
  absl::Status Localize(const v1::Observation& observation);
  // Reports the answer to the watchers of the fleet.
  void Report(const v1::LocalizeResponse& answer, int journey);

  // The next request that is read loads the maps of a wildcard.
  bool loads_maps_ = false;
  std::unique_ptr<LocalizationSession> session_;
  // Null: the stream belongs to no robot.
  std::unique_ptr<FleetBoard::Presence> presence_;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_LOCALIZE_STREAM_H_
