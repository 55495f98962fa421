// Streams that are open, so that a draining server can end them.
#ifndef SERVER_RPC_STREAM_REGISTRY_H_
#define SERVER_RPC_STREAM_REGISTRY_H_

#include <atomic>
#include <cstddef>
#include <memory>
#include <set>

#include "homing/base/mutex.h"

namespace homing::server {

class OpenStream {
 public:
  virtual ~OpenStream() = default;
  // Ends the stream with UNAVAILABLE, once what is on its way to the disk is answered.
  virtual void Drain() = 0;
  // Now and then: ends the stream if its caller is known no more, or if nothing moved for too long.
  virtual void Tick() = 0;
};

// Thread-safe.
class StreamRegistry {
 public:
  // False when draining: the stream is not added and must end.
  bool Add(const std::shared_ptr<OpenStream>& stream);
  void Remove(const std::shared_ptr<OpenStream>& stream);
  // No stream is added from now on; those that are there are told.
  void Drain();
  bool draining() const;
  // Tells every stream.
  void Tick();
  // Until every stream was removed.
  void AwaitNone();
  // How much of `all` each open stream may have: at least 1, at most `most`. Without a lock, so
  // that each message may ask.
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
