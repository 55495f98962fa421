// A store that passes every call to another one. A test derives from it and overrides the calls
// that it watches or changes.
#ifndef TESTS_SUPPORT_FORWARDING_STORE_H_
#define TESTS_SUPPORT_FORWARDING_STORE_H_

#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "storage/journey_store.h"

namespace homing::storage {

class ForwardingStore : public JourneyStore {
 public:
  // `store` must outlive it.
  explicit ForwardingStore(JourneyStore* store) : store_(store) {}

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
  absl::StatusOr<AcquiredJourney> AcquireJourney(const std::string& name,
                                                 const std::string& writer_id) override {
    return store_->AcquireJourney(name, writer_id);
  }
  absl::Status CheckLease(const std::string& name, const std::string& writer_id) override {
    return store_->CheckLease(name, writer_id);
  }
  absl::StatusOr<JourneyGrowth> LoadSteps(const std::string& name, std::int64_t first) override {
    return store_->LoadSteps(name, first);
  }
  absl::StatusOr<std::vector<JourneyMark>> LoadMarks(
      const std::vector<std::string>& names) override {
    return store_->LoadMarks(names);
  }
  bool shared() const override { return store_->shared(); }
  absl::Status SetReaders(const std::string& name,
                          const std::vector<std::string>& readers) override {
    return store_->SetReaders(name, readers);
  }
  std::vector<absl::Status> AppendSteps(const std::vector<JourneyAppend>& appends) override {
    return store_->AppendSteps(appends);
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

 protected:
  JourneyStore* const store_;
};

}  // namespace homing::storage

#endif  // TESTS_SUPPORT_FORWARDING_STORE_H_
