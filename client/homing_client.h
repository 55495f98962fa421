// Matches landmarks and localises on the way home.
#ifndef CLIENT_HOMING_CLIENT_H_
#define CLIENT_HOMING_CLIENT_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/observation_stream.h"
#include "client/reconnect.h"
#include "client/resend_buffer.h"
#include "homing/v1/homing_service.grpc.pb.h"

namespace homing::client {

struct LocalizingOptions {
  v1::LocalizeConfig config;
  // Most observations sent and not yet answered. [1, 10000].
  int window = 32;
  // Answered observations that are sent again after a broken link. The belief starts from the
  // answer before them; they restore the motion and the landmarks in view. A server that takes over
  // many robots computes them all before it has a new answer. Fewer are sent if a proxy resets the
  // stream before there is a new answer. [1, 10000].
  int replay = 24;
};

// Not thread-safe.
class HomingClient {
 public:
  // Called once for each observation's answer, in order, on another thread. An error stops.
  using OnAnswer = std::function<absl::Status(const v1::LocalizeResponse&)>;

  // REQUIRES: `connection` outlives the client.
  explicit HomingClient(
      const Connection* connection, Log log = [](auto&) {});

  // Runs to the end of `observations`. CANCELLED: stopped. Errors of Localize.
  absl::Status Localize(const LocalizingOptions& options, ObservationStream* observations,
                        const OnAnswer& on_answer, const std::stop_token& stop = {});

  absl::StatusOr<v1::MatchLandmarksResponse> Match(const v1::MatchLandmarksRequest& request,
                                                   const std::stop_token& stop = {});

 private:
  // Runs one stream. Its numbers begin at 0: those of a later stream are shifted.
  absl::Status Attempt(const LocalizingOptions& options, ResendBuffer* buffer,
                       const OnAnswer& on_answer, const std::stop_token& stop, bool* progress);

  void KeepPrior(const v1::LocalizeResponse& answer, int replay);

  const Connection* connection_;
  Log log_;
  std::unique_ptr<v1::HomingService::StubInterface> stub_;
  // The last sequence given to on_answer.
  std::int64_t reported_ = -1;
  // Of the next attempt: fewer than the options say if a proxy resets streams before they make
  // progress, since it may do so after so many bytes.
  int window_ = 1;
  int replay_ = 1;
  // The robot's places at the last answers, by sequence: a new stream starts from the one before
  // the first observation that is sent again.
  std::map<std::int64_t, v1::LocalizePrior> priors_;
};

}  // namespace homing::client

#endif  // CLIENT_HOMING_CLIENT_H_
