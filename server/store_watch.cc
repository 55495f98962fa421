#include "server/store_watch.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

namespace homing::server {
namespace {

// Interval between two looks at the last write's result, and between two test writes.
constexpr std::chrono::milliseconds kLook{200};
constexpr std::chrono::milliseconds kTry{1000};

}  // namespace

StoreWatch::StoreWatch(storage::JourneyStore* store, OnChange on_change)
    : store_(store), on_change_(std::move(on_change)), thread_([this] { return Look(); }) {}

std::chrono::milliseconds StoreWatch::Look() {
  const absl::Status status = well_ ? store_->WriteHealth() : store_->ProbeWrite();
  if (status.ok() != well_) {
    well_ = status.ok();
    if (well_) {
      spdlog::info("the store accepts writes again");
    } else {
      spdlog::error("not serving: the store accepts no writes: {}", std::string(status.message()));
    }
    on_change_(well_);
  }
  return well_ ? kLook : kTry;
}

}  // namespace homing::server
