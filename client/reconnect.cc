#include "client/reconnect.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "client/backoff.h"
#include "client/rpc_status.h"

namespace homing::client {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Attempts after OUT_OF_RANGE, by which the server asks for another observation.
constexpr int kMaxCorrections = 3;

absl::Status GiveUp(const Connection& connection, const absl::Status& last) {
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(connection.options().retry_for);
  return absl::Status(
      last.code(), absl::StrCat("gave up after ", seconds.count(), " s without an answer from ",
                                connection.options().address, ": ", std::string(last.message())));
}

}  // namespace

absl::Status Reconnecting(const Connection& connection, const std::stop_token& stop, const Log& log,
                          const std::function<absl::Status(bool* progress)>& attempt) {
  Backoff backoff;
  int corrections = 0;
  auto last_progress = SteadyClock::now();
  while (true) {
    bool progress = false;
    absl::Status status = attempt(&progress);
    if (stop.stop_requested()) return absl::CancelledError("stopped");
    if (status.ok()) return status;
    if (progress) {
      last_progress = SteadyClock::now();
      backoff.Reset();
      corrections = 0;
    }
    const bool correctable = absl::IsOutOfRange(status) && ++corrections <= kMaxCorrections;
    if (!correctable && !IsRetriable(status)) return status;
    if (SteadyClock::now() - last_progress >= connection.options().retry_for) {
      return GiveUp(connection, status);
    }
    const auto wait =
        std::max(backoff.Next(), RetryDelay(status).value_or(std::chrono::milliseconds(0)));
    log(absl::StrCat("link lost (", std::string(status.message()), "), trying again in ",
                     wait.count(), " ms"));
    if (!SleepFor(wait, stop)) return absl::CancelledError("stopped");
  }
}

}  // namespace homing::client
