// The file in which observations wait for the link: SQLite, so that it survives a power cut.
#ifndef CLIENT_ROBOT_OBSERVATION_FILE_H_
#define CLIENT_ROBOT_OBSERVATION_FILE_H_

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "absl/status/statusor.h"

namespace homing::robot {

// A serialized v1::Observation.
struct StoredObservation {
  std::int64_t sequence = 0;
  std::string bytes;
};

// Not thread-safe.
class ObservationFile {
 public:
  // FAILED_PRECONDITION: it holds observations of another journey, or another program has it open;
  // UNAVAILABLE: the file cannot be opened.
  static absl::StatusOr<ObservationFile> Open(const std::string& path, const std::string& journey);
  ObservationFile(ObservationFile&&) noexcept;
  ObservationFile& operator=(ObservationFile&&) noexcept;
  ~ObservationFile();

  // All or none are in the file afterwards.
  absl::Status Append(std::span<const StoredObservation> observations);
  // The first of at least `sequence`; std::nullopt: none.
  absl::StatusOr<std::optional<StoredObservation>> Read(std::int64_t sequence) const;
  // Deletes all before `sequence`, except `kept`. Returns their bytes.
  absl::StatusOr<std::int64_t> DropBefore(std::int64_t sequence, std::int64_t kept);
  // Adds `shift` to the numbers from `first` on.
  absl::Status Renumber(std::int64_t first, std::int64_t shift);

  struct Extent {
    // The sequence after the last one; 0: the file is empty.
    std::int64_t end = 0;
    std::int64_t count = 0;
    // Size of all observations, bytes.
    std::int64_t bytes = 0;
  };
  absl::StatusOr<Extent> Measure() const;

 private:
  explicit ObservationFile(std::unique_ptr<SQLite::Database> database);
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace homing::robot

#endif  // CLIENT_ROBOT_OBSERVATION_FILE_H_
