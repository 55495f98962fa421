// The store on PostgreSQL, which many servers share.
#ifndef STORAGE_POSTGRES_POSTGRES_JOURNEY_STORE_H_
#define STORAGE_POSTGRES_POSTGRES_JOURNEY_STORE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "storage/journey_store.h"
#include "storage/postgres/heartbeat.h"
#include "storage/postgres/pg_connection.h"
#include "storage/postgres/pg_session.h"
#include "storage/postgres/pg_writer.h"

namespace homing::storage::postgres {

// Thread-safe, as every JourneyStore.
class PostgresJourneyStore final : public JourneyStore {
 public:
  // Migrates the tables unless read-only, and shows from now on that this server is alive. Errors
  // of OpenJourneyStore.
  static absl::StatusOr<std::unique_ptr<PostgresJourneyStore>> Open(const StoreOptions& options);
  absl::Status CreateJourney(const JourneyRecord& record) override;
  absl::StatusOr<JourneyRecord> GetJourney(const std::string& name) override;
  absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string& prefix,
                                                          const std::string& after,
                                                          int limit) override;
  absl::Status DeleteJourney(const std::string& name) override;
  absl::Status FinishJourney(const std::string& name) override;
  absl::StatusOr<AcquiredJourney> AcquireJourney(const std::string& name,
                                                 const std::string& writer_id) override;
  absl::Status CheckLease(const std::string& name, const std::string& writer_id) override;
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
  bool read_only() const override { return database_.access() == PgConnection::Access::kReadOnly; }
  bool shared() const override { return true; }
  absl::StatusOr<std::unique_ptr<std::istream>> BackUp() override;
  absl::Status CreateModel(const StoredModel& model) override;
  absl::StatusOr<StoredModel> GetModel(const std::string& name) override;
  absl::StatusOr<std::vector<StoredModel>> ListModels(const std::string& after, int limit) override;

 private:
  using Body = PgPool::Body;

  PostgresJourneyStore(const std::string& url, PgConnection::Access access);
  absl::Status Prepare();
  // As PgWriter::Write.
  absl::Status Write(PgWriter::Scope scope, const Body& body);
  // The result of `query`, of one statement or in one read transaction.
  template <typename Result, typename Query>
  absl::StatusOr<Result> Read(PgWriter::Scope scope, Query query);

  PgDatabase database_;
  // Random number of this run of this server.
  const std::int64_t server_id_;
  PgPool readers_;

  PgWriter writer_;
  // Null for a read-only store.
  std::unique_ptr<Heartbeat> heartbeat_;
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_POSTGRES_JOURNEY_STORE_H_
