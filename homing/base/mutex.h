// Mutexes, locks and a condition variable that clang's thread-safety analysis can check. They wrap
// the standard library's types, which have no attributes in libstdc++. ThreadSanitizer understands
// them. `.ci/run locks` runs the check.
#ifndef HOMING_BASE_MUTEX_H_
#define HOMING_BASE_MUTEX_H_

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <shared_mutex>

#if defined(__clang__)
#define HOMING_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define HOMING_THREAD_ATTRIBUTE(x)
#endif

// On a member: read and written only while the mutex is held.
#define HOMING_GUARDED_BY(mutex) HOMING_THREAD_ATTRIBUTE(guarded_by(mutex))
// On a pointer: the same for the object it points to.
#define HOMING_PT_GUARDED_BY(mutex) HOMING_THREAD_ATTRIBUTE(pt_guarded_by(mutex))
// On a function: the caller holds the mutex.
#define HOMING_REQUIRES(...) HOMING_THREAD_ATTRIBUTE(requires_capability(__VA_ARGS__))
#define HOMING_REQUIRES_SHARED(...) HOMING_THREAD_ATTRIBUTE(requires_shared_capability(__VA_ARGS__))
// On a function: locks or unlocks the mutex.
#define HOMING_ACQUIRE(...) HOMING_THREAD_ATTRIBUTE(acquire_capability(__VA_ARGS__))
#define HOMING_ACQUIRE_SHARED(...) HOMING_THREAD_ATTRIBUTE(acquire_shared_capability(__VA_ARGS__))
#define HOMING_TRY_ACQUIRE(...) HOMING_THREAD_ATTRIBUTE(try_acquire_capability(__VA_ARGS__))
#define HOMING_RELEASE(...) HOMING_THREAD_ATTRIBUTE(release_capability(__VA_ARGS__))
#define HOMING_RELEASE_SHARED(...) HOMING_THREAD_ATTRIBUTE(release_shared_capability(__VA_ARGS__))
// On a function that locks in a way that the analysis cannot follow: say why.
#define HOMING_UNCHECKED_LOCKS HOMING_THREAD_ATTRIBUTE(no_thread_safety_analysis)

namespace homing {

class ConditionVariable;

template <typename Native>
class HOMING_THREAD_ATTRIBUTE(capability("mutex")) BasicMutex {
 public:
  BasicMutex() = default;
  BasicMutex(const BasicMutex&) = delete;
  BasicMutex& operator=(const BasicMutex&) = delete;

  void Lock() HOMING_ACQUIRE() { native_.lock(); }
  void Unlock() HOMING_RELEASE() { native_.unlock(); }
  bool TryLock() HOMING_TRY_ACQUIRE(true) { return native_.try_lock(); }

 protected:
  friend class ConditionVariable;
  Native native_;
};

using Mutex = BasicMutex<std::mutex>;
// The same thread may lock it again.
using RecursiveMutex = BasicMutex<std::recursive_mutex>;

// Many readers, or one writer.
class HOMING_THREAD_ATTRIBUTE(capability("mutex")) SharedMutex
    : public BasicMutex<std::shared_mutex> {
 public:
  void LockShared() HOMING_ACQUIRE_SHARED() { native_.lock_shared(); }
  void UnlockShared() HOMING_RELEASE_SHARED() { native_.unlock_shared(); }
};

// Holds a mutex while it lives, except between Unlock and Lock.
template <typename AnyMutex>
class HOMING_THREAD_ATTRIBUTE(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(AnyMutex& mutex) HOMING_ACQUIRE(mutex) : mutex_(mutex) { mutex_.Lock(); }
  ~MutexLock() HOMING_RELEASE() {
    if (held_) {
      mutex_.Unlock();
    }
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void Lock() HOMING_ACQUIRE() {
    mutex_.Lock();
    held_ = true;
  }
  void Unlock() HOMING_RELEASE() {
    held_ = false;
    mutex_.Unlock();
  }

 private:
  AnyMutex& mutex_;
  bool held_ = true;
};

// Waits for a change of what a mutex guards. It may wake up without a change: wait in a loop,
// `while (!condition) changed.Wait(mutex);`.
class ConditionVariable {
 public:
  // Unlocks while it waits.
  void Wait(Mutex& mutex) HOMING_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.native_, std::adopt_lock);
    changed_.wait(lock);
    lock.release();
  }
  // False: `end` has come.
  template <typename Clock, typename Duration>
  bool WaitUntil(Mutex& mutex, const std::chrono::time_point<Clock, Duration>& end)
      HOMING_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.native_, std::adopt_lock);
    const std::cv_status status = changed_.wait_until(lock, end);
    lock.release();
    return status == std::cv_status::no_timeout;
  }
  void NotifyOne() { changed_.notify_one(); }
  void NotifyAll() { changed_.notify_all(); }

 private:
  std::condition_variable changed_;
};

}  // namespace homing

#endif  // HOMING_BASE_MUTEX_H_
