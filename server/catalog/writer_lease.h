// The lease of a journey's writer: one writer at a time, until it is silent for too long.
#ifndef SERVER_CATALOG_WRITER_LEASE_H_
#define SERVER_CATALOG_WRITER_LEASE_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "absl/status/status.h"

namespace homing::server {

// Steady time, given by the caller.
using TimePoint = std::chrono::steady_clock::time_point;

// INVALID_ARGUMENT naming `field`: over 128 characters, or not printable ASCII.
absl::Status CheckWriterId(const std::string& writer_id, const std::string& field);

// Not thread-safe. The lease outlives the stream that took it: after a broken link the robot can
// continue its journey.
class WriterLease {
 public:
  static constexpr std::chrono::seconds kDuration{15};
  // Ends a writer's stream with the given error.
  using Evict = std::function<void(absl::Status)>;

  // ABORTED: another program holds the lease at `now`. The part of a writer_id behind "#" names the
  // source of the recording, not the program.
  absl::Status CheckFree(const std::string& writer_id, TimePoint now) const;
  // A new claim. It ends the previous claim, whose evict is returned through `previous` for the
  // caller to call. REQUIRES: CheckFree(writer_id, now).ok().
  std::uint64_t Take(const std::string& writer_id, TimePoint now, Evict evict, Evict* previous);
  // `claim` is the current one.
  bool Holds(std::uint64_t claim) const { return active_ && claim == claim_; }
  // There is a claim, whether its stream is open or not.
  bool is_held() const { return active_; }
  void Renew(TimePoint now) { renewed_ = now; }
  // The claim's stream has ended; the lease stays valid.
  void EndStream(std::uint64_t claim) { open_ = open_ && claim != claim_; }
  // ABORTED: a stream of the current lease is open.
  absl::Status CheckNoStream(TimePoint now) const;
  // Ends the claim and the lease; returns the callback that evicts the claim's stream.
  Evict Release();

 private:
  std::string writer_id_;
  std::uint64_t claim_ = 0;
  bool active_ = false;
  bool open_ = false;
  TimePoint renewed_;
  Evict evict_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_WRITER_LEASE_H_
