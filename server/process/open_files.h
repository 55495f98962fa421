// Raises the limit on open files and connections.
#ifndef SERVER_PROCESS_OPEN_FILES_H_
#define SERVER_PROCESS_OPEN_FILES_H_

#include <sys/resource.h>

namespace homing {

// Raises it as far as possible without privileges: the default of 1,024 is too small for a fleet.
// Best effort.
inline void RaiseOpenFileLimit() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
  }
}

}  // namespace homing

#endif  // SERVER_PROCESS_OPEN_FILES_H_
