#include "server/metrics/metered_store.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "storage/forwarding_store.h"

namespace homing::server {
namespace {

using Clock = std::chrono::steady_clock;

class MeteredStore final : public storage::ForwardingStore {
 public:
  MeteredStore(std::unique_ptr<JourneyStore> store, Metrics* metrics)
      : ForwardingStore(store.get()), owned_(std::move(store)), metrics_(metrics) {}

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

 private:
  const std::unique_ptr<JourneyStore> owned_;
  Metrics* const metrics_;
};

}  // namespace

std::unique_ptr<storage::JourneyStore> Metered(std::unique_ptr<storage::JourneyStore> store,
                                               Metrics* metrics) {
  return std::make_unique<MeteredStore>(std::move(store), metrics);
}

}  // namespace homing::server
