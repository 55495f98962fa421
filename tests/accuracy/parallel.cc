#include "tests/accuracy/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace homing::accuracy {

void InParallel(std::size_t count, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
    threads.emplace_back([&] {
      for (std::size_t at = next++; at < count; at = next++) job(at);
    });
  }
}

}  // namespace homing::accuracy
