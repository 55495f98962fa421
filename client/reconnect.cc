#include "client/reconnect.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "client/backoff.h"
#include "client/rpc_status.h"

namespace homing::client {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Most consecutive attempts without progress: after OUT_OF_RANGE, which the expected number
// corrects, and after a proxy's reset.
constexpr int kMaxCorrections = 3;

std::int64_t Seconds(std::chrono::milliseconds duration) {
  return std::chrono::duration_cast<std::chrono::seconds>(duration).count();
}

absl::Status GiveUp(const Connection& connection, const absl::Status& last) {
  return absl::Status(last.code(),
                      absl::StrCat("gave up after ", Seconds(connection.options().retry_for),
                                   " s without an answer from ", connection.options().address, ": ",
                                   std::string(last.message())));
}

}  // namespace

absl::Status Reconnecting(const Connection& connection, const std::stop_token& stop, const Log& log,
                          const std::function<absl::Status(bool* progress)>& attempt) {
  Backoff backoff;
  int corrections = 0;
  bool lost = false;
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
    const bool correctable =
        (absl::IsOutOfRange(status) || IsReset(status)) && ++corrections <= kMaxCorrections;
    if (!correctable && !IsRetriable(status)) return status;
    if (SteadyClock::now() - last_progress >= connection.options().retry_for) {
      return GiveUp(connection, status);
    }
    const auto wait =
        std::max(backoff.Next(), RetryDelay(status).value_or(std::chrono::milliseconds(0)));
    // Logs once an outage.
    if (progress || !lost) {
      log(absl::StrCat("link lost (", std::string(status.message()), "), trying again for ",
                       Seconds(connection.options().retry_for), " s"));
    }
    lost = true;
    if (!SleepFor(wait, stop)) return absl::CancelledError("stopped");
    connection.AwaitReady(stop);
    if (stop.stop_requested()) return absl::CancelledError("stopped");
  }
}

}  // namespace homing::client
