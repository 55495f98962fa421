// Streams that are open, so that a draining server can end them. Source: own design.
#ifndef SERVER_STREAM_REGISTRY_H_
#define SERVER_STREAM_REGISTRY_H_

#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>

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

 private:
  mutable std::mutex mutex_;
  std::condition_variable removed_;
  std::set<std::shared_ptr<OpenStream>> streams_;
  bool draining_ = false;
};

}  // namespace homing::server

#endif  // SERVER_STREAM_REGISTRY_H_
