// Recognises landmarks and localises on the way home.
#ifndef CLIENT_HOMING_CLIENT_H_
#define CLIENT_HOMING_CLIENT_H_

#include <cstdint>
#include <functional>
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
  // Answered observations sent again after a broken link, so that the belief comes back. [1,
  // 10000].
  int replay = 64;
};

// Not thread-safe.
class HomingClient {
 public:
  // Each observation's answer once, in order, on another thread. An error stops.
  using OnAnswer = std::function<absl::Status(const v1::LocalizeResponse&)>;

  // REQUIRES: `connection` outlives the client.
  explicit HomingClient(
      const Connection* connection, Log log = [](auto&) {});

  // To the end of `observations`. CANCELLED: stopped. Others as Localize.
  absl::Status Localize(const LocalizingOptions& options, ObservationStream* observations,
                        const OnAnswer& on_answer, const std::stop_token& stop = {});

  absl::StatusOr<v1::MatchLandmarksResponse> Match(const v1::MatchLandmarksRequest& request,
                                                   const std::stop_token& stop = {});

 private:
  // One stream; a stream's numbers begin at 0, so those of a later one are shifted.
  absl::Status Attempt(const LocalizingOptions& options, ResendBuffer* buffer,
                       const OnAnswer& on_answer, const std::stop_token& stop, bool* progress);

  const Connection* connection_;
  Log log_;
  std::unique_ptr<v1::HomingService::StubInterface> stub_;
  // Last sequence handed to on_answer.
  std::int64_t reported_ = -1;
};

}  // namespace homing::client

#endif  // CLIENT_HOMING_CLIENT_H_
