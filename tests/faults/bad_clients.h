// Clients that no server should have, one after the other until the end.
#ifndef TESTS_FAULTS_BAD_CLIENTS_H_
#define TESTS_FAULTS_BAD_CLIENTS_H_

#include <atomic>
#include <string>
#include <thread>

namespace homing::faults {

class BadClients {
 public:
  explicit BadClients(const std::string& address);
  ~BadClients();
  int visits() const { return visits_; }

 private:
  void Run();

  const std::string address_;
  std::atomic<int> visits_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace homing::faults

#endif  // TESTS_FAULTS_BAD_CLIENTS_H_
