// Compiles a loop for several kinds of processor; the program selects one when it starts.
#ifndef HOMING_BASE_VECTOR_CLONES_H_
#define HOMING_BASE_VECTOR_CLONES_H_

// Sanitizers are not initialised when the selection runs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define HOMING_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HOMING_VECTOR_CLONES
#endif

#endif  // HOMING_BASE_VECTOR_CLONES_H_
