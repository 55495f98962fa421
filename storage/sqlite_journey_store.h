// The store on SQLite: one connection writes, others read beside it. Source: own design.
#ifndef STORAGE_SQLITE_JOURNEY_STORE_H_
#define STORAGE_SQLITE_JOURNEY_STORE_H_

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "storage/checkpointer.h"
#include "storage/connection.h"
#include "storage/file_identity.h"
#include "storage/journey_store.h"
#include "storage/query_connections.h"
#include "storage/step_appends.h"
#include "storage/store_lock.h"

namespace homing::storage {

class SqliteJourneyStore final : public JourneyStore {
 public:
  // `lock` and `queries` are null for a store in memory, which only its one connection sees;
  // `writer` is null for a read-only one.
  SqliteJourneyStore(std::string path, std::unique_ptr<StoreLock> lock,
                     std::unique_ptr<Connection> writer, std::unique_ptr<QueryConnections> queries)
      : path_(std::move(path)),
        lock_(std::move(lock)),
        writer_(std::move(writer)),
        appends_(writer_.get()),
        queries_(std::move(queries)) {}

  // REQUIRES: a file, and not read-only. Once.
  absl::Status StartCheckpoints(int busy_timeout_ms);

  absl::Status CreateJourney(const JourneyRecord& record) override;
  absl::StatusOr<JourneyRecord> GetJourney(const std::string& name) override;
  absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string& prefix,
                                                          const std::string& after,
                                                          int limit) override;
  absl::Status DeleteJourney(const std::string& name) override;
  absl::Status FinishJourney(const std::string& name) override;
  absl::Status SetWriter(const std::string& name, const std::string& writer_id) override;
  absl::Status SetReaders(const std::string& name,
                          const std::vector<std::string>& readers) override;
  std::vector<absl::Status> AppendSteps(const std::vector<JourneyAppend>& appends) override;
  absl::StatusOr<JourneyMap> LoadMap(const std::string& name) override;
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
  // In one transaction: what changes more than appends do, which then read their rows again.
  absl::Status Write(const Body& body);
  absl::Status Transact(const Body& body);
  // The files are those that were opened. A store in memory has none.
  absl::Status CheckFiles();
  void NoteLogPages(int pages);
  // After damage: whether the whole file passes SQLite's check again. It is tried now and then.
  bool IsHealed();
  void NoteHealth(const absl::Status& written, bool changed);
  absl::Status Read(const Body& body);
  // What `query` gives in one read transaction.
  template <typename Result, typename Query>
  absl::StatusOr<Result> ReadOne(Query query);

  const std::string path_;
  // Let go of last.
  const std::unique_ptr<StoreLock> lock_;
  std::mutex write_mutex_;
  // Guarded by write_mutex_, the pointer apart.
  const std::unique_ptr<Connection> writer_;
  // Guarded by write_mutex_.
  StepAppends appends_;
  std::mutex health_mutex_;
  // Guarded by health_mutex_, so that asking never waits for a write.
  absl::Status write_health_;
  std::chrono::steady_clock::time_point next_check_;
  std::unique_ptr<FileIdentity> files_;
  std::int64_t page_bytes_ = 0;
  std::unique_ptr<QueryConnections> queries_;
  // Ends before the writer.
  std::unique_ptr<Checkpointer> checkpointer_;
  // While a copy is being made.
  std::mutex backup_mutex_;
};

}  // namespace homing::storage

#endif  // STORAGE_SQLITE_JOURNEY_STORE_H_
