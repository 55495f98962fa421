// Waits for a server's health to become this or that.
#ifndef TESTS_FAULTS_AWAIT_HEALTH_H_
#define TESTS_FAULTS_AWAIT_HEALTH_H_

#include <chrono>
#include <string>
#include <thread>

#include "server/config/health_check.h"

namespace homing::faults {

// False: not within half a minute.
inline bool AwaitHealth(const std::string& address, bool serving) {
  for (int i = 0; i < 300; ++i) {
    if (server::CheckHealth(address).ok() == serving) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

}  // namespace homing::faults

#endif  // TESTS_FAULTS_AWAIT_HEALTH_H_
