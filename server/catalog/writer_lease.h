// Who may write a journey: one writer at a time, for as long as it is heard of.
// Source: own design.
#ifndef SERVER_CATALOG_WRITER_LEASE_H_
#define SERVER_CATALOG_WRITER_LEASE_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "absl/status/status.h"

namespace homing::server {

// Steady time, passed in.
using TimePoint = std::chrono::steady_clock::time_point;

// INVALID_ARGUMENT naming `field`: over 128 characters, or not printable ASCII.
absl::Status CheckWriterId(const std::string& writer_id, const std::string& field);

// Not thread-safe: the holder locks. The lease outlives the stream that took it, so that a robot
// whose link broke finds its journey as it left it.
class WriterLease {
 public:
  static constexpr std::chrono::seconds kDuration{15};
  // Ends the stream of a writer with the given error.
  using Evict = std::function<void(absl::Status)>;

  // ABORTED: another program's lease lives at `now`. What stands behind "#" in a writer_id says
  // what the program records from, not which program it is.
  absl::Status CheckFree(const std::string& writer_id, TimePoint now) const;
  // A new claim, which ends the claim before; its evict is handed out to be called.
  // REQUIRES: CheckFree(writer_id, now).ok().
  std::uint64_t Take(const std::string& writer_id, TimePoint now, Evict evict, Evict* previous);
  // Whether `claim` is the present one.
  bool Holds(std::uint64_t claim) const { return active_ && claim == claim_; }
  void Renew(TimePoint now) { renewed_ = now; }
  // The claim's stream has ended; the lease lives on.
  void EndStream(std::uint64_t claim) { open_ = open_ && claim != claim_; }
  // ABORTED: a stream of a lease that lives is open.
  absl::Status CheckNoStream(TimePoint now) const;
  // Ends the claim and the lease; hands out the evict of the claim ended.
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
