// How many files and connections this process may have open.
#ifndef SERVER_PROCESS_OPEN_FILES_H_
#define SERVER_PROCESS_OPEN_FILES_H_

#include <sys/resource.h>

namespace homing {

// Raises the limit as far as is allowed without privileges: what is usual, 1,024, is less than a
// fleet. Best effort.
inline void RaiseOpenFileLimit() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
  }
}

}  // namespace homing

#endif  // SERVER_PROCESS_OPEN_FILES_H_
