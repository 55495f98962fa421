// Looks at a database whatever its state, and saves what is whole.
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
  // OK: whole. Else why not.
  absl::Status status;
};

struct Diagnosis {
  std::int64_t schema_version = 0;
  // What SQLite finds wrong with its pages, at most 100 lines; what keeps the doctor from seeing
  // all rows. Empty: nothing.
  std::vector<std::string> problems;
  std::vector<Finding> journeys;
  std::vector<Finding> models;
};

// How many are not whole.
int CountDamaged(const std::vector<Finding>& findings);
bool IsWhole(const Diagnosis& diagnosis);

// Reads every page and loads every journey; changes nothing in the file. A server may be running on
// it. DATA_LOSS: nothing can be read; FAILED_PRECONDITION: no such file, another program's, or of
// another version.
absl::StatusOr<Diagnosis> Examine(const std::string& path);

// As Examine; and writes what is whole, journeys that are still being recorded included, into the
// new file `to`. ALREADY_EXISTS.
absl::StatusOr<Diagnosis> Salvage(const std::string& path, const std::string& to);

}  // namespace homing::storage

#endif  // STORAGE_DOCTOR_H_
