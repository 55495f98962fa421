// A store that hands everything on to another: tests override what they watch or disturb.
#ifndef TESTS_SERVER_SESSION_FORWARDING_STORE_H_
#define TESTS_SERVER_SESSION_FORWARDING_STORE_H_

#include <string>
#include <vector>

#include "storage/journey_store.h"

namespace homing::server {

class ForwardingStore : public storage::JourneyStore {
 public:
  explicit ForwardingStore(storage::JourneyStore* store) : store_(store) {}

  absl::Status CreateJourney(const storage::JourneyRecord& record) override {
    return store_->CreateJourney(record);
  }
  absl::StatusOr<storage::JourneyRecord> GetJourney(const std::string& name) override {
    return store_->GetJourney(name);
  }
  absl::StatusOr<std::vector<storage::JourneyRecord>> ListJourneys(const std::string& prefix,
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
  std::vector<absl::Status> AppendSteps(
      const std::vector<storage::JourneyAppend>& appends) override {
    return store_->AppendSteps(appends);
  }
  absl::StatusOr<JourneyMap> LoadMap(const std::string& name) override {
    return store_->LoadMap(name);
  }
  absl::StatusOr<JourneyTail> LoadTail(const std::string& name) override {
    return store_->LoadTail(name);
  }
  absl::Status ImportJourney(const storage::JourneyRecord& record, const JourneyMap& map) override {
    return store_->ImportJourney(record, map);
  }
  absl::Status CreateModel(const storage::StoredModel& model) override {
    return store_->CreateModel(model);
  }
  absl::StatusOr<storage::StoredModel> GetModel(const std::string& name) override {
    return store_->GetModel(name);
  }
  absl::StatusOr<std::vector<storage::StoredModel>> ListModels(const std::string& after,
                                                               int limit) override {
    return store_->ListModels(after, limit);
  }

 protected:
  storage::JourneyStore* const store_;
};

}  // namespace homing::server

#endif  // TESTS_SERVER_SESSION_FORWARDING_STORE_H_
