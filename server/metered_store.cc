#include "server/metered_store.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace homing::server {
namespace {

using storage::JourneyRecord;
using storage::StoredModel;
using Clock = std::chrono::steady_clock;

class MeteredStore final : public storage::JourneyStore {
 public:
  MeteredStore(std::unique_ptr<JourneyStore> store, Metrics* metrics)
      : store_(std::move(store)), metrics_(metrics) {}

  std::vector<absl::Status> AppendSteps(
      const std::vector<storage::JourneyAppend>& appends) override {
    const Clock::time_point begin = Clock::now();
    std::vector<absl::Status> statuses = store_->AppendSteps(appends);
    const auto stored = std::count_if(statuses.begin(), statuses.end(),
                                      [](const absl::Status& status) { return status.ok(); });
    metrics_->Committed(static_cast<int>(stored), stored > 0 || statuses.empty(),
                        std::chrono::duration<double>(Clock::now() - begin).count());
    return statuses;
  }

  absl::Status CreateJourney(const JourneyRecord& record) override {
    return store_->CreateJourney(record);
  }
  absl::StatusOr<JourneyRecord> GetJourney(const std::string& name) override {
    return store_->GetJourney(name);
  }
  absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string& prefix,
                                                          const std::string& after,
                                                          int limit) override {
    return store_->ListJourneys(prefix, after, limit);
  }
  absl::Status DeleteJourney(const std::string& name) override {
    return store_->DeleteJourney(name);
  }
  absl::Status FinishJourney(const std::string& name) override {
    return store_->FinishJourney(name);
  }
  absl::Status SetWriter(const std::string& name, const std::string& writer_id) override {
    return store_->SetWriter(name, writer_id);
  }
  absl::StatusOr<JourneyMap> LoadMap(const std::string& name) override {
    return store_->LoadMap(name);
  }
  absl::StatusOr<JourneyTail> LoadTail(const std::string& name) override {
    return store_->LoadTail(name);
  }
  absl::Status ImportJourney(const JourneyRecord& record, const JourneyMap& map) override {
    return store_->ImportJourney(record, map);
  }
  absl::Status WriteHealth() override { return store_->WriteHealth(); }
  absl::Status ProbeWrite() override { return store_->ProbeWrite(); }
  bool read_only() const override { return store_->read_only(); }
  absl::StatusOr<std::unique_ptr<std::istream>> BackUp() override { return store_->BackUp(); }
  absl::Status CreateModel(const StoredModel& model) override { return store_->CreateModel(model); }
  absl::StatusOr<StoredModel> GetModel(const std::string& name) override {
    return store_->GetModel(name);
  }
  absl::StatusOr<std::vector<StoredModel>> ListModels(const std::string& after,
                                                      int limit) override {
    return store_->ListModels(after, limit);
  }

 private:
  const std::unique_ptr<JourneyStore> store_;
  Metrics* const metrics_;
};

}  // namespace

std::unique_ptr<storage::JourneyStore> Metered(std::unique_ptr<storage::JourneyStore> store,
                                               Metrics* metrics) {
  return std::make_unique<MeteredStore>(std::move(store), metrics);
}

}  // namespace homing::server
