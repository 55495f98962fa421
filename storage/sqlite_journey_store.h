// The store on SQLite: one connection writes while others read.
#ifndef STORAGE_SQLITE_JOURNEY_STORE_H_
#define STORAGE_SQLITE_JOURNEY_STORE_H_

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "homing/base/mutex.h"
#include "storage/checkpointer.h"
#include "storage/connection.h"
#include "storage/file_identity.h"
#include "storage/journey_store.h"
#include "storage/query_connections.h"
#include "storage/space_reserve.h"
#include "storage/step_appends.h"
#include "storage/store_lock.h"

namespace homing::storage {

// Thread-safe, as every JourneyStore.
class SqliteJourneyStore final : public JourneyStore {
 public:
  // `lock` and `queries` are null for a store in memory, which has one connection. `writer` is null
  // for a read-only store.
  SqliteJourneyStore(std::string path, std::unique_ptr<StoreLock> lock,
                     std::unique_ptr<Connection> writer, std::unique_ptr<QueryConnections> queries)
      : path_(std::move(path)),
        lock_(std::move(lock)),
        writer_(std::move(writer)),
        appends_(writer_.get()),
        queries_(std::move(queries)) {}

  // REQUIRES: a file, and not read-only. Once.
  absl::Status StartCheckpoints(int busy_timeout_ms);
  // REQUIRES: a file, and not read-only. Once.
  void KeepReserve(std::unique_ptr<SpaceReserve> reserve);
  // Finishes the deletions that an earlier server did not finish.
  absl::Status FinishDeletions();

  absl::Status CreateJourney(const JourneyRecord& record) override;
  absl::StatusOr<JourneyRecord> GetJourney(const std::string& name) override;
  absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string& prefix,
                                                          const std::string& after,
                                                          int limit) override;
  absl::Status DeleteJourney(const std::string& name) override;
  absl::Status FinishJourney(const std::string& name) override;
  absl::StatusOr<AcquiredJourney> AcquireJourney(const std::string& name,
                                                 const std::string& writer_id) override;
  absl::Status SetReaders(const std::string& name,
                          const std::vector<std::string>& readers) override;
  std::vector<absl::Status> AppendSteps(const std::vector<JourneyAppend>& appends) override;
  absl::StatusOr<JourneyMap> LoadMap(const std::string& name) override;
  absl::StatusOr<JourneyGrowth> LoadSteps(const std::string& name, std::int64_t first) override;
  absl::StatusOr<std::vector<JourneyMark>> LoadMarks(
      const std::vector<std::string>& names) override;
  absl::StatusOr<JourneyTail> LoadTail(const std::string& name) override;
  absl::Status ImportJourney(const JourneyRecord& record, const JourneyMap& map) override;
  absl::Status WriteHealth() override;
  absl::Status ProbeWrite() override;
  bool read_only() const override { return writer_ == nullptr; }
  absl::StatusOr<std::unique_ptr<std::istream>> BackUp() override;
  absl::Status CreateModel(const StoredModel& model) override;
  absl::StatusOr<StoredModel> GetModel(const std::string& name) override;
  absl::StatusOr<std::vector<StoredModel>> ListModels(const std::string& after, int limit) override;

 private:
  using Body = std::function<absl::Status(Connection&)>;
  // Runs `body` in one transaction and clears the rows that appends keep: for all writes but
  // appends.
  absl::Status Write(const Body& body);
  absl::Status Transact(const Body& body);
  struct Pieces {
    // Steps that one transaction deletes.
    std::int64_t steps;
    // Before each piece the log is moved into the file; the piece then overwrites the log.
    bool reuse_log;
  };
  // Deletes a journey; in pieces if it has more steps than one piece. IN and OUT `is_hidden`: an
  // earlier call hid the journey, and some of its steps are left to delete.
  absl::Status DeleteOnce(const std::string& name, Pieces pieces, bool* is_hidden);
  // Deletes the steps that are left of all hidden journeys.
  absl::Status DeleteHidden(Pieces pieces);
  // Fills the reserve if the disk has space.
  void FillReserve() HOMING_REQUIRES(reserve_mutex_);
  // As FillReserve; does nothing while a deletion uses the reserve.
  void TryFillReserve();
  // Limits the log to the bytes by which the file can grow once the reserve is freed.
  void LimitLog() HOMING_REQUIRES(reserve_mutex_);
  // UNAVAILABLE unless the files are still those that were opened. OK for a store in memory.
  absl::Status CheckFiles();
  void NoteLogPages(int pages);
  // True if a damaged file passes SQLite's whole check again. The check runs at most every 10 s.
  bool IsHealed();
  void NoteHealth(const absl::Status& written, bool changed);
  absl::Status Read(const Body& body);
  // The result of `query` in one read transaction.
  template <typename Result, typename Query>
  absl::StatusOr<Result> ReadOne(Query query);

  const std::string path_;
  // Released last.
  const std::unique_ptr<StoreLock> lock_;
  Mutex write_mutex_;
  const std::unique_ptr<Connection> writer_ HOMING_PT_GUARDED_BY(write_mutex_);
  // Bodies of Write and AppendSteps use it: they run with write_mutex_ held.
  StepAppends appends_;
  Mutex health_mutex_;
  // It has its own mutex, so that a reader never waits for a write.
  absl::Status write_health_ HOMING_GUARDED_BY(health_mutex_);
  std::chrono::steady_clock::time_point next_check_;
  std::unique_ptr<FileIdentity> files_;
  std::int64_t page_bytes_ = 0;
  std::unique_ptr<QueryConnections> queries_;
  // Must end before the writer.
  std::unique_ptr<Checkpointer> checkpointer_;
  // A copy is being made.
  std::atomic<bool> backing_up_ = false;
  Mutex reserve_mutex_;
  // Null for a store in memory.
  std::unique_ptr<SpaceReserve> reserve_ HOMING_GUARDED_BY(reserve_mutex_);
};

}  // namespace homing::storage

#endif  // STORAGE_SQLITE_JOURNEY_STORE_H_
