// The order of messages in a stream of observations: `config` first and once, then `observation`.
#ifndef SERVER_SERVICE_STREAM_MESSAGES_H_
#define SERVER_SERVICE_STREAM_MESSAGES_H_

#include "absl/status/status.h"
#include "homing/base/field_error.h"

namespace homing::server {

// Calls `begin` with the config or `observe` with the observation. `begun`: begin has succeeded.
// INVALID_ARGUMENT: another order, or neither of the two.
template <typename Request, typename Begin, typename Observe>
absl::Status TakeMessage(const Request& request, bool begun, Begin begin, Observe observe) {
  if (request.has_config()) {
    return begun ? FieldError("config", "must come once, in the first message")
                 : begin(request.config());
  }
  if (!request.has_observation()) return FieldError("request", "must be config or observation");
  return begun ? observe(request.observation())
               : FieldError("observation", "came before config; the first message must be config");
}

}  // namespace homing::server

#endif  // SERVER_SERVICE_STREAM_MESSAGES_H_
