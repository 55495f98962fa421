// Drives kept in files, so that flow is computed once.
#ifndef TESTS_ACCURACY_DRIVE_CACHE_H_
#define TESTS_ACCURACY_DRIVE_CACHE_H_

#include <optional>
#include <string>

#include "tests/accuracy/drive.h"

namespace homing::accuracy {

class DriveCache {
 public:
  // Empty: keeps nothing.
  explicit DriveCache(std::string folder) : folder_(std::move(folder)) {}

  std::optional<Drive> Read(const std::string& name) const;
  // Other programs may write the same drive at the same time.
  void Write(const std::string& name, const Drive& drive) const;

 private:
  std::string PathOf(const std::string& name) const;

  std::string folder_;
};

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_DRIVE_CACHE_H_
