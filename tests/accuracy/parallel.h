#ifndef TESTS_ACCURACY_PARALLEL_H_
#define TESTS_ACCURACY_PARALLEL_H_

#include <cstddef>
#include <functional>

namespace homing::accuracy {

// Calls job(0) .. job(count - 1) on all cores.
void InParallel(std::size_t count, const std::function<void(std::size_t)>& job);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_PARALLEL_H_
