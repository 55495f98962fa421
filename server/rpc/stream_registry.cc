#include "server/rpc/stream_registry.h"

#include <algorithm>

#include "homing/base/mutex.h"

namespace homing::server {

bool StreamRegistry::Add(const std::shared_ptr<OpenStream>& stream) {
  const MutexLock lock(mutex_);
  if (!draining_) {
    streams_.insert(stream);
    size_ = streams_.size();
  }
  return !draining_;
}

void StreamRegistry::Remove(const std::shared_ptr<OpenStream>& stream) {
  const MutexLock lock(mutex_);
  streams_.erase(stream);
  size_ = streams_.size();
  removed_.NotifyAll();
}

void StreamRegistry::Drain() {
  std::set<std::shared_ptr<OpenStream>> streams;
  {
    const MutexLock lock(mutex_);
    draining_ = true;
    streams = streams_;
  }
  for (const std::shared_ptr<OpenStream>& stream : streams) {
    stream->Drain();
  }
}

void StreamRegistry::Tick() {
  std::set<std::shared_ptr<OpenStream>> streams;
  {
    const MutexLock lock(mutex_);
    streams = streams_;
  }
  for (const std::shared_ptr<OpenStream>& stream : streams) {
    stream->Tick();
  }
}

void StreamRegistry::AwaitNone() {
  const MutexLock lock(mutex_);
  while (!streams_.empty()) removed_.Wait(mutex_);
}

bool StreamRegistry::draining() const {
  const MutexLock lock(mutex_);
  return draining_;
}

std::size_t StreamRegistry::ShareOf(std::size_t all, std::size_t most) const {
  return std::clamp<std::size_t>(all / std::max<std::size_t>(1, size_), 1, most);
}

}  // namespace homing::server
