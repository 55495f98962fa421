// The observations that the server acknowledged, as its clients saw them.
#ifndef TESTS_FAULTS_LEDGER_H_
#define TESTS_FAULTS_LEDGER_H_

#include <cstdint>
#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "homing/base/mutex.h"

namespace homing::faults {

struct Acknowledged {
  // First number that is not durable.
  std::int64_t next_sequence = 0;
  bool finished = false;
  // Whether frames were sent: the first makes no step.
  bool frames = false;
};

struct LedgerCheck {
  // Acknowledged observations that are not there; journeys that are not there, or not finished,
  // count one each.
  std::int64_t lost = 0;
  // Steps beyond those that the observations make.
  std::int64_t twice = 0;
};

// Thread-safe.
class Ledger {
 public:
  void Created(const std::string& journey, bool frames);
  void Advanced(const std::string& journey, std::int64_t next_sequence);
  void Finished(const std::string& journey);
  void Deleted(const std::string& journey);

  std::map<std::string, Acknowledged> entries() const;

 private:
  mutable Mutex mutex_;
  std::map<std::string, Acknowledged> entries_;
};

// Compares a database (the files of a dead server) with the acknowledged observations. Opens it as
// a server would, which changes it.
absl::StatusOr<LedgerCheck> CheckDatabase(const std::string& url,
                                          const std::map<std::string, Acknowledged>& entries);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_LEDGER_H_
