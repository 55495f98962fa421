// Accepting connections while the process has no file descriptor left.
//
// gRPC 1.51 stops listening for good after one accept4 that fails because no descriptor is left.
// This definition replaces the C library's in the whole program: when no descriptor is left, it
// closes a reserve descriptor, accepts the connection, closes it at once, and returns EAGAIN.
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <mutex>

namespace {

std::mutex mutex;
std::atomic<int> reserve = -1;

int Accept(int listener, sockaddr* address, socklen_t* length, int flags) {
  return static_cast<int>(::syscall(SYS_accept4, listener, address, length, flags));
}

void Refill() {
  if (reserve < 0) reserve = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
}

}  // namespace

extern "C" int accept4(int listener, sockaddr* address, socklen_t* length, int flags) {
  const int accepted = Accept(listener, address, length, flags);
  if (accepted >= 0 || (errno != EMFILE && errno != ENFILE)) {
    const int error = errno;
    if (reserve < 0) {
      const std::lock_guard lock(mutex);
      Refill();
    }
    errno = error;
    return accepted;
  }
  const std::lock_guard lock(mutex);
  if (reserve >= 0) ::close(reserve);
  reserve = -1;
  const int refused = Accept(listener, nullptr, nullptr, SOCK_CLOEXEC);
  if (refused >= 0) ::close(refused);
  Refill();
  errno = EAGAIN;
  return -1;
}
