// Examines a database in any state, and salvages its readable part.
#ifndef STORAGE_DOCTOR_H_
#define STORAGE_DOCTOR_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::storage {

// One journey or deviation model.
struct Finding {
  std::string name;
  std::int64_t step_count = 0;
  // OK: complete. Else the damage.
  absl::Status status;
};

struct Diagnosis {
  std::int64_t schema_version = 0;
  // Problems that SQLite reports about its pages, at most 100 lines, and problems that hide rows
  // from the doctor. Empty: none.
  std::vector<std::string> problems;
  std::vector<Finding> journeys;
  std::vector<Finding> models;
};

// The number of damaged findings.
int CountDamaged(const std::vector<Finding>& findings);
bool IsWhole(const Diagnosis& diagnosis);

// Reads every page and loads every journey; does not change the file. `path` may be the URL of a
// PostgreSQL database, whose pages pg_amcheck examines. A server may be using it.
// DATA_LOSS: nothing can be read; FAILED_PRECONDITION: no such file, another program's file, or
// another version.
absl::StatusOr<Diagnosis> Examine(const std::string& path);

// As Examine, of a file; also writes the complete items, including journeys that are still being
// recorded, into the new file `to`. ALREADY_EXISTS.
absl::StatusOr<Diagnosis> Salvage(const std::string& path, const std::string& to);

}  // namespace homing::storage

#endif  // STORAGE_DOCTOR_H_
