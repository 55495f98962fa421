// What a process does with memory that it has freed. Source: own design.
#ifndef HOMING_FREED_MEMORY_H_
#define HOMING_FREED_MEMORY_H_

#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace homing {

// Keeps the buffers of a frame for the next one: given back, they come again page by page, each
// zeroed by the kernel, which can take longer than the frame. At most 16 MiB an arena stay unused;
// buffers over 4 MiB are still given back. For main(), before threads start.
inline void KeepFreedMemory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
#endif
}

}  // namespace homing

#endif  // HOMING_FREED_MEMORY_H_
