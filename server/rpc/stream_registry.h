// The open streams, so that a draining server can end them.
#ifndef SERVER_RPC_STREAM_REGISTRY_H_
#define SERVER_RPC_STREAM_REGISTRY_H_

#include <atomic>
#include <cstddef>
#include <memory>
#include <set>

#include "homing/base/mutex.h"

namespace homing::server {

// Both may be called on any thread.
class OpenStream {
 public:
  virtual ~OpenStream() = default;
  // Ends the stream with UNAVAILABLE, after the answers to pending commits.
  virtual void Drain() = 0;
  // Called periodically: ends the stream if its caller lost its access, or if it is idle.
  virtual void Tick() = 0;
};

// Thread-safe.
class StreamRegistry {
 public:
  // False when draining: the stream is not added and must end.
  bool Add(const std::shared_ptr<OpenStream>& stream);
  void Remove(const std::shared_ptr<OpenStream>& stream);
  // Accepts no more streams, and drains the open ones.
  void Drain();
  bool draining() const;
  // Calls Tick of every stream.
  void Tick();
  // Waits until every stream was removed.
  void AwaitNone();
  // `all` divided by the number of open streams: at least 1, at most `most`. Takes no lock, so that
  // each message may call it.
  std::size_t ShareOf(std::size_t all, std::size_t most) const;

 private:
  mutable Mutex mutex_;
  ConditionVariable removed_;
  std::set<std::shared_ptr<OpenStream>> streams_ HOMING_GUARDED_BY(mutex_);
  std::atomic<std::size_t> size_ = 0;
  bool draining_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_RPC_STREAM_REGISTRY_H_
